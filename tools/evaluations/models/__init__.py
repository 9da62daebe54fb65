"""Evaluations of action models: accuracy of their predictions."""
