"""Property tests draw the same examples in every run, and no clock judges them: a check fails for a reason or never.

`pytest --hypothesis-profile explore` draws new ones.
"""

import os

from hypothesis import HealthCheck, settings

pytest_plugins = ["tests.support.safety.promises"]
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")  # for tests that import onnxruntime before tailor.models

settings.register_profile("explore", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("repeat", settings.get_profile("explore"), derandomize=True)
settings.load_profile("repeat")
