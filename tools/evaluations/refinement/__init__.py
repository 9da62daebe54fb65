"""Evaluations of refinement: what does it gain?"""
