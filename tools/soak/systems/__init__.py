"""Launched systems, seen from a session on their bus, and people who look after them."""
