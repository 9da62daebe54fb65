"""The executive with an external planner: real processes on a real bus, recorded and verified."""

import json
import shlex
import subprocess
import sys

import pytest

from tailor.runtime.processes.child import tailor
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.messages import PlanAnswer, PlanReport, PlanRequest, TickReport, VelocityCommand
from tests.support.bus_system import ROOT, bus_system, free_endpoint
from tests.support.patience import PATIENCE_S, gone, wait_until
from tests.support.stalls import repeat_on_stall

OWN = shlex.join(tailor("plan", "--links"))  # our own command, as anybody's vhpop
LIMIT_S = 1.5  # for a planner that hangs
HANGS = """
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(300)"])
open(sys.argv[0] + ".pids", "w").write(f"{os.getpid()} {child.pid}")
while True: pass"""


def program(tmp_path, body):
    """A stand-in for vhpop, and the command that runs it."""
    tmp_path.mkdir(exist_ok=True)
    path = tmp_path / "vhpop"
    path.write_text(f"#!{sys.executable}\nimport os, subprocess, sys, time\n{body}\n")
    path.chmod(0o755)
    return path


LEAVE = "1e" * 16


def command(*arguments):
    return subprocess.run(
        tailor(*map(str, arguments)), capture_output=True, text=True, timeout=3 * PATIENCE_S, cwd=ROOT
    )


def run_with(tmp_path, planner, before_percepts=lambda: None, limit_s=PATIENCE_S):
    """Messages by type of a recorded drive to the first waypoint, after `tailor verify` has found it equal."""
    config, path = tmp_path / "planner.toml", tmp_path / "run.mcap"
    config.write_text(f"[planner]\ncommand = {json.dumps(str(planner))}\nlimit_s = {limit_s}\n")
    with bus_system() as (session, endpoint, start):
        at = ("--scenario", "waypoints", "--seed", "1", "--connect", endpoint)
        recorder = start("tailor.tools.main", "record", "--output", path, "--connect", endpoint)
        wait_until(session.publisher("plan", "agilo").matched, "recorder")
        status = session.inbox(("status",), "agilo")
        executive = start(
            "tailor.tools.main",
            "executive",
            "soccer",
            *at,
            "--config",
            config,
            "--once",
            "--goal",
            "(visited way1)",
            "--sender",
            LEAVE,
        )
        wait_until(status.drain, "executive")
        before_percepts()
        start("tailor.tools.main", "sim", "agilo", *at, "--leave", LEAVE)
        assert executive.wait(2 * PATIENCE_S) == 0
        recorder.stop(PATIENCE_S)
    verify = command("verify", path, "--json")
    assert verify.stdout, verify.stderr
    (verdict,) = json.loads(verify.stdout)
    assert verdict["difference"] is None
    found = {}
    for _, message in open_recording(path).decoded():
        found.setdefault(type(message), []).append(message)
    return found


def ways(found):
    return [(plan.status, plan.way) for plan in found[PlanReport]]


@pytest.mark.xdist_group("systems")
def test_a_plan_of_a_real_process_is_executed_and_the_recording_verifies(tmp_path):
    found = run_with(tmp_path, OWN)
    assert len(found[PlanRequest]) == len(found[PlanAnswer]) == 1
    assert found[PlanAnswer][0].outcome == "answered"
    assert ways(found) == [("solved", "external"), ("solved", "suffix")]


@pytest.mark.promise("P8")
@pytest.mark.xdist_group("live")
def test_a_planner_that_hangs_costs_its_limit_but_no_tick_and_leaves_no_process(tmp_path):
    folders = (tmp_path / str(number) for number in range(3))

    def waited_without_missing_a_tick():
        folder = next(folders)
        found = run_with(folder, program(folder, HANGS), limit_s=LIMIT_S)
        (answer,) = found[PlanAnswer]
        assert answer.outcome == "timeout"
        asked_s = (answer.stamp_ns - found[PlanRequest][0].stamp_ns) / 1e9
        assert LIMIT_S <= asked_s < LIMIT_S + 0.5
        assert ways(found)[:2] == [("failed", "external"), ("solved", "searched")]
        waiting = [tick for tick in found[TickReport] if tick.stamp_ns <= answer.stamp_ns]
        assert sum(tick.skipped for tick in waiting) == 0
        assert len(waiting) >= 15
        assert max(tick.control_ns for tick in waiting) < 50e6
        assert all(command.v == 0.0 for command in found[VelocityCommand] if command.stamp_ns < answer.stamp_ns)
        assert (folder / "vhpop.pids").exists(), "it was killed before it hung"
        assert all(gone(int(pid)) for pid in (folder / "vhpop.pids").read_text().split())

    repeat_on_stall(3, waited_without_missing_a_tick)


@pytest.mark.slow
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        ("os.abort()", "crashed"),
        ("os.kill(os.getpid(), 9)", "crashed"),
        ("sys.stdout.buffer.write(os.urandom(5000))", "answered"),
        ("print('no plan')", "answered"),
        ("while True: sys.stdout.write('x' * 65536)", "flood"),
        (None, "missing"),
    ],
)
def test_a_planner_that_fails_is_replaced_by_our_own_and_the_recording_verifies(tmp_path, body, outcome):
    planner = program(tmp_path, body or "")
    found = run_with(tmp_path, planner, lambda: None if body else planner.unlink())
    (answer,) = found[PlanAnswer]
    assert answer.outcome == outcome
    assert ways(found) == [("failed", "external"), ("solved", "searched"), ("solved", "suffix")]
    assert sum(tick.skipped for tick in found[TickReport]) <= 2, "but for stalls of a busy machine"


@pytest.mark.slow
@pytest.mark.xdist_group("systems")
def test_the_failure_of_a_planner_is_shown_to_the_user(tmp_path):
    planner = program(tmp_path, "os.abort()")
    flags = ("--scenario", "waypoints", "--once", "--seed", "1", "--planner", planner, "--connect", free_endpoint())
    up = command("up", "soccer", *flags)
    output = " ".join(up.stdout.split())
    assert "planner failed: crashed: the planner ended with code -6" in output
    assert output.endswith("achieved")
