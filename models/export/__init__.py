"""ONNX graphs of learned models, and their way into the zoo."""
