"""The robots that ship, declared as any package declares its own."""
