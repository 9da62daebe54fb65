"""MCAP recordings: writing, reading damaged files, playing, snapshots."""
