"""No run without its recording: it does not begin when the file cannot be written, and ends with it where required."""

import os
import random
import resource
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

from tailor.runtime.processes.child import Child
from tests.faults.supervision.launched import launched
from tests.support.bus_system import ROOT, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

BURNERS = 4
# The launcher looks whether it can write the file before it starts anything; here that is lost in between.
LATER = """
import sys
from tailor.tools.launch import system
from tailor.tools.main import main
system.check_new_file = lambda path: None
sys.exit(main(sys.argv[1:]))
"""


@contextmanager
def burners(number):
    children = [Child("burner", [sys.executable, "-c", "while True: pass"]) for _ in range(number)]
    try:
        yield
    finally:
        for child in children:
            child.kill()


@pytest.mark.promise("P51")
@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize("place", ["a file/run.mcap", "/proc/run.mcap"])
@pytest.mark.parametrize(("tries", "load"), [(1, 0), pytest.param(10, BURNERS, marks=pytest.mark.slow)])
def test_nothing_moves_when_its_recording_cannot_be_written(tries, load, place, tmp_path):
    (tmp_path / "a file").write_text("not a folder")
    path, phases = str(tmp_path / place), random.Random(load)
    with burners(load):
        for _ in range(tries):
            time.sleep(phases.uniform(0.0, 0.2))
            command = [
                sys.executable,
                "-P",
                "-c",
                LATER,
                "up",
                "soccer",
                "--record",
                path,
                "--connect",
                free_endpoint(),
            ]
            done = subprocess.run(command, capture_output=True, text=True, timeout=2 * PATIENCE_S, cwd=ROOT)
            lines = done.stdout.splitlines()
            assert done.returncode == 1
            assert lines[0].startswith(f"tailor record: {path.removesuffix('/run.mcap')}")
            assert lines[1] == "record ended with 2; not started again", "and no line of an executive"
            assert lines[2:] == ["failed: the recorder did not start"], "nothing else has printed anything"


@pytest.mark.promise("P51")
@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize("way", [pytest.param("killed", marks=pytest.mark.slow), "full disk"])
def test_a_run_that_requires_its_recording_ends_with_it(way, tmp_path):
    with launched(tmp_path, "--require-recording") as system:
        wait_until(system.moves, "robot moves")
        recorder = system.process("record").pid
        if way == "killed":
            os.kill(recorder, signal.SIGKILL)
        else:  # the kernel refuses to make the file larger, as on a full disk
            size = system.recording.stat().st_size + 1000
            resource.prlimit(recorder, resource.RLIMIT_FSIZE, (size, size))
        assert system.up.wait(PATIENCE_S) == 1
    expected = "failed: the recording ended" if way == "killed" else "failed: the recording is incomplete: disk: "
    assert system.log.read_text().splitlines()[-1].startswith(expected)
