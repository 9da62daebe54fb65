"""Judges of motion and memory, and what they report. Pure."""
