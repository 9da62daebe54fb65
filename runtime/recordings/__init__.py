"""Recordings: recorder, reader, player, copies, snapshots."""
