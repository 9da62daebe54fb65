"""Readings of sensors as a tick takes them: their senders, age and rate, and which are measurements."""
