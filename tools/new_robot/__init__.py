"""Writes a new robot's package from templates: `common/` and one folder a kind of robot."""
