"""EXPERIENCE: episodes, features, learners, ONNX, cards. The executive loads models.runtime only."""
