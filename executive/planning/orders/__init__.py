"""Soundness of a partial-order plan in every order of its steps."""
