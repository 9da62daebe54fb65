"""Evaluations of subgoal assertion: which failures does it prevent?"""
