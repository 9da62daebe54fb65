"""Recordings as runs of an executive: read, compared, replayed in part."""
