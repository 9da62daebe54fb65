"""A recorder whose bus goes away says so, and goes on when it is back."""

import signal
import subprocess

from runtime.processes import tailor
from runtime.session import open_router
from tests.e2e.bus_system import ROOT, free_endpoint
from tools.record import BACK, GONE


def test_a_recorder_tells_that_its_bus_is_gone_and_that_it_is_back(tmp_path):
    endpoint = free_endpoint()
    with open_router(endpoint):
        recorder = subprocess.Popen(
            tailor("record", "-o", str(tmp_path / "a.mcap"), "--quiet", "--connect", endpoint),
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        while not (tmp_path / "a.mcap").exists():
            assert recorder.poll() is None
    try:
        assert recorder.stderr.readline().strip() == GONE
        with open_router(endpoint):
            assert recorder.stderr.readline().strip() == BACK
            recorder.send_signal(signal.SIGINT)
            assert recorder.wait(30) == 0
    finally:
        recorder.kill()
