"""Scenes of robots: one source for the page of a run, for pictures, and for markers and transforms."""
