"""`tailor up --once` ends, whatever becomes of its executive and its simulator."""

import os
import signal
import subprocess
from contextlib import suppress

import pytest

from tailor.runtime.processes.child import tailor
from tests.support.bus_system import child_pid, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

PROCESSES = {"executive": "executive", "sim": "driver"}


def child_if_any(parent, name):
    with suppress(LookupError):
        return child_pid(parent, name)
    return None


@pytest.mark.parametrize("name", ["executive", pytest.param("sim", marks=pytest.mark.slow)])
def test_a_run_ends_when_a_process_of_it_is_started_again(name):
    words = tailor("up", "soccer", "--once", "--connect", free_endpoint())
    up = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        wait_until(lambda: child_if_any(up.pid, "executive"), "executive")  # after the simulator, which is ready
        os.kill(child_pid(up.pid, name), signal.SIGKILL)
        output, _ = up.communicate(timeout=PATIENCE_S)
    finally:
        up.kill()
    assert up.returncode == 1, output
    assert output.splitlines()[-1] == f"failed: the {PROCESSES[name]} was started again"
