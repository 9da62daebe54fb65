"""Loads, checks and runs ONNX action models. The only place that imports onnxruntime."""
