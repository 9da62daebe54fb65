"""Commands for drivers of real robots."""
