"""Data structures of partial plans, ground and lifted: conditions, orderings, persistent lists."""
