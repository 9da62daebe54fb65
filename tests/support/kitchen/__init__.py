"""Moves of the B21 for tests."""
