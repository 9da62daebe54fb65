"""Keys of the processes on several machines: an authority, certificates, and the role of each name."""
