"""Evaluations of refinement: improvement over greedy choices."""
