"""`tailor up --once` ends, whatever becomes of its executive."""

import os
import signal
import subprocess
from contextlib import suppress

from tailor.runtime.processes.child import tailor
from tests.support.bus_system import child_pid, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until


def child_if_any(parent, name):
    with suppress(LookupError):
        return child_pid(parent, name)
    return None


def test_a_run_ends_when_its_executive_ended_before_it_had_armed_the_robot():
    words = tailor("up", "soccer", "--once", "--connect", free_endpoint())
    up = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        pid = wait_until(lambda: child_if_any(up.pid, "executive"), "executive")
        os.kill(pid, signal.SIGKILL)
        output, _ = up.communicate(timeout=PATIENCE_S)
    finally:
        up.kill()
    assert up.returncode == 1, output
    assert "starting again in 0.2 s, without a goal; next: tailor arm agilo, then tailor goal\n" in output
    assert output.splitlines()[-1] == "failed: the executive was started again"
