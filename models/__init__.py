"""Action models: episodes, features, learners, ONNX export, cards. The executive loads tailor.models.runtime only."""
