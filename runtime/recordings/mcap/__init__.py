"""The MCAP file format: writing one file, and reading it in whatever state it is."""
