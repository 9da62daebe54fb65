"""Evaluations that reproduce the paper's tables and figures: one module each, with `configure` and `run`."""
