"""The actuator-side stop: the last link before the motors. Standard library alone."""
