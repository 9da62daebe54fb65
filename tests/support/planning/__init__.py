"""PDDL for tests: random problems and texts that were altered."""
