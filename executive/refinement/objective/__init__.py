"""Objective of refinement: sequences of instantiated actions and their predicted cost."""
