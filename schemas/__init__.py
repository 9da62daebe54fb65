"""WORDS: what may be said on the bus. Imports nothing of ours."""
