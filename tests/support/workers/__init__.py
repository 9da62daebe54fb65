"""How several workers share the tests: those that wait, and what they compile."""
