"""Action models: episodes, features, learners, ONNX export, cards. The executive loads tailor.models.runtime only."""

import os

# Since 1.29 onnxruntime's wheel starts threads that keep a database below the home folder and report sessions and models
# to its vendor: traffic that no robot may send unasked, and threads beside the loop. It reads this when it is imported.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
