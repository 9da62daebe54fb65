"""MCAP recordings: writing, reading, recovery of damaged files, playback, snapshots."""
