"""Names of the constants that trees are written in: who writes a graph and who reads it back agree on them."""

from __future__ import annotations

BEYOND = "beyond"  # (u, f + 1): times features and a one is above zero beyond each threshold
STRIDES = "strides"  # (k, u), see models/trees/cells.py
FIRST = "first_cell"  # (k, 1)
LEAF = "leaf_of_cell"  # (cells,)
FORMULAS = "formulas"  # (l, f + 1) of one tree: slopes and intercept of each leaf
TERM = "term_{}"  # (k, m) of k trees of at most m leaves: one for each column of their formulas
LOW, HIGH = "low", "high"  # (k, m), ends of what a leaf says
LEAF_STD = "spread"  # (1, l) of one tree
