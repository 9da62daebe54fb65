"""Fitted trees as arrays: splits, cells, linear leaves, and their names in ONNX graphs."""
