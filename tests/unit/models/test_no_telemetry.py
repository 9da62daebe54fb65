"""A robot reports nothing to anybody unasked: onnxruntime's wheels upload telemetry unless they are stopped."""

import os
import subprocess
import sys

LOADED = """
import os
from tailor.models.runtime import load_robot
load_robot("agilo")
print(len(os.listdir("/proc/self/task")))
"""


def test_onnxruntime_starts_no_thread_and_writes_no_file(tmp_path):
    environment = {name: value for name, value in os.environ.items() if name != "ORT_DISABLE_TELEMETRY"}
    environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # BLAS would start threads, too
    environment |= {"HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)}
    for name in ("CI", "TF_BUILD", "GITHUB_ACTIONS"):  # they stop it as well
        environment.pop(name, None)
    command = [sys.executable, "-P", "-c", LOADED]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert int(done.stdout) == 1
    assert list(tmp_path.iterdir()) == []
