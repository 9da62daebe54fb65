"""`tailor check-driver` tries a driver on the bus; hardware needs a person's consent."""

import json
import subprocess

import pytest

from tailor.runtime.processes.child import tailor
from tests.support.bus_system import ROOT, bus_system
from tests.support.robots.driving import ready
from tests.support.stalls import repeat_on_stall

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("live")]


def checked(endpoint, *flags):
    command = tailor("check-driver", "agilo", *flags, "--connect", endpoint)
    return subprocess.run(command, capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)


def broken(found):
    """What a report finds wrong, and nothing else: a failure of this test shows it whole."""
    clauses = [(each["clause"], each["faults"], each["skipped"]) for each in found["verdicts"]]
    return [each for each in clauses if any(each[1:])], found["misfits"], found["not_compared"]


def test_the_simulator_keeps_to_every_clause_and_moves_as_the_models_robot(tmp_path):
    def attempt():
        done = checked(endpoint, "--json", "--report", str(tmp_path / "report.md"))
        found = json.loads(done.stdout)
        assert broken(found) == ([], [], "")
        assert (done.returncode, found["kept"], found["kind"]) == (0, True, "simulator")

    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "sim", "agilo", "--connect", endpoint)
        ready(session, "agilo")
        repeat_on_stall(2, attempt)
    assert "| stops without commands | kept |" in (tmp_path / "report.md").read_text()


def test_the_example_keeps_to_every_clause_once_a_person_agrees():
    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "driver", f"{ROOT}/examples/rover_driver.py:Rover", "--connect", endpoint)
        ready(session, "agilo")
        refused = checked(endpoint)
        assert (refused.returncode, refused.stdout) == (2, "")
        assert "expected --yes or a terminal to confirm" in refused.stderr
        repeat_on_stall(2, lambda: kept(checked(endpoint, "--yes")))


def kept(done):
    assert done.returncode == 0, [line for line in done.stdout.splitlines() if not line.startswith("kept")]
    assert "fit: it moves as the models' robot does" in done.stdout


def test_without_a_driver_nothing_is_tried():
    with bus_system() as (_, endpoint, _):
        done = checked(endpoint)
    assert done.returncode == 2
    assert "no driver of agilo within 5 s, expected one on the bus" in done.stderr
