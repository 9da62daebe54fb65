"""Baseline of subgoal assertion: ways around what stands there, as an engineer computes them by hand."""
