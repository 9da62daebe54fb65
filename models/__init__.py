"""EXPERIENCE: episodes, features, learners, ONNX, cards. The executive loads tailor.models.runtime only."""
