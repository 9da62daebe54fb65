"""Bounds on a model's predictions over boxes of arguments, read from its ONNX graph."""
