"""Decisions of a recorded run, and their explanation as text."""
