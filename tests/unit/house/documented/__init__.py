"""Flags, settings and goals that pages name, compared with those that there are."""
