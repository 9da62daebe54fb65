"""Commands that look at recordings and running systems."""
