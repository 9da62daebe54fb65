"""Evaluations of the writing arm."""
