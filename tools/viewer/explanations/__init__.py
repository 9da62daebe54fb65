"""Explanations of subgoals: predictions for the chosen values and their alternatives."""
