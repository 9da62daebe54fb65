"""Faults, and what they do to a system."""
