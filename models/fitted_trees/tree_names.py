"""Names of the ONNX constants that hold trees, shared by the export and by the reader of bounds."""

from __future__ import annotations

BEYOND = "beyond"  # (u, f + 1): the product with features and a one is positive beyond each threshold
STRIDES = "strides"  # (k, u), see models/fitted_trees/cells.py
FIRST = "first_cell"  # (k, 1)
LEAF = "leaf_of_cell"  # (cells,)
FORMULAS = "formulas"  # (l, f + 1) of one tree: slopes and intercept of each leaf
TERM = "term_{}"  # (k, m) of k trees of at most m leaves: one for each column of their formulas
LOW, HIGH = "low", "high"  # (k, m), range that a leaf is clipped to
LEAF_STD = "spread"  # (1, l) of one tree
NETWORK_WEIGHTS, NETWORK_BIAS = "network_weights_{}", "network_bias_{}"  # of each layer, (k, out, in) and (k, out, 1)
NETWORK_LOW, NETWORK_HIGH = "network_low", "network_high"  # range that the mean of the networks is clipped to
MEMBER_WEIGHT = "weight_of_member_{}"  # of a blend: of its trees and of its networks, in the order of their constants
INTERVALS = "intervals"  # the node of the tree whose leaves hold intervals; its last feature is the std
INTERVAL_LOWER, INTERVAL_UPPER = "interval_lower", "interval_upper"  # (l,), added to the mean
