"""Golden recordings: renewal and comparison."""
