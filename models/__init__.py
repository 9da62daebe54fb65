"""Action models: episodes, features, learners, ONNX export, cards. The executive loads tailor.models.runtime only."""

import os

# Since 1.29 onnxruntime's wheels start threads that keep a database in the home folder and report sessions and models
# to the vendor: traffic that nobody asked for, and threads beside the loop. They read this variable when imported.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
