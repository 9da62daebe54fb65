"""Geometry of the B21 and its kitchen: what its simulated body, its executive and its viewers share."""
