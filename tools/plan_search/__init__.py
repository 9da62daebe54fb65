"""Searches for a plan within limits: the built-in one, an external planner, or both; plans' least orderings."""
