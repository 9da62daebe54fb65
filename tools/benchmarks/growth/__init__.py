"""How costs grow with the work."""
