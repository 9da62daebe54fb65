"""PDDL: readers, the language as values, writers."""
