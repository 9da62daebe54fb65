"""Child processes that cannot outlive their parent, and their supervisor."""
