"""Pieces of a command line: endpoints, deployment files, checked numbers, terminal output."""
