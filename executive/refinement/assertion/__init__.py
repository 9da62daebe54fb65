"""Subgoal assertion: inserts a subgoal before an action that is predicted to fail (paper, section 7)."""
