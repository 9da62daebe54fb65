"""Which flaw to resolve next, and how partial plans are ranked."""
