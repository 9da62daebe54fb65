"""A whole system with an external planner: real processes on a real bus, recorded and verified."""

import json
import shlex
import subprocess
import sys

import pytest

from runtime.processes import tailor
from runtime.recording import open_recording
from schemas.messages import PlanAnswer, PlanReport, PlanRequest, TickReport, VelocityCommand
from tests.e2e.bus_system import ROOT, free_endpoint
from tests.faults.test_planner_process import gone

OWN = shlex.join(tailor("plan", "--links"))  # our own command, as anybody's vhpop


def run_with(tmp_path, planner, limit_s=10.0):
    """Messages of a recorded run by type, after `tailor verify` has found it equal."""
    config, path = tmp_path / "planner.toml", tmp_path / "run.mcap"
    config.write_text(f"[planner]\ncommand = {json.dumps(planner)}\nlimit_s = {limit_s}\n")
    flags = ("--scenario", "waypoints", "--once", "--seed", "1", "--config", config, "--record", path)
    up = subprocess.run(
        tailor("up", "soccer", *map(str, flags), "--connect", free_endpoint()),
        capture_output=True, text=True, timeout=120, cwd=ROOT,
    )  # fmt: skip
    assert (up.returncode, up.stdout.splitlines()[-1]) == (0, "achieved"), up.stdout + up.stderr
    verify = subprocess.run(
        tailor("verify", str(path), "--json"), capture_output=True, text=True, timeout=120, cwd=ROOT
    )
    (verdict,) = json.loads(verify.stdout)
    assert verdict["difference"] is None
    found = {"screen": " ".join(up.stdout.split())}
    for _, message in open_recording(path).decoded():
        found.setdefault(type(message), []).append(message)
    return found


@pytest.mark.xdist_group("live")
def test_a_plan_of_a_real_process_is_executed_and_the_recording_verifies(tmp_path):
    found = run_with(tmp_path, OWN)
    assert len(found[PlanRequest]) == len(found[PlanAnswer]) == 1
    assert found[PlanAnswer][0].outcome == "answered"
    assert [(plan.status, plan.way) for plan in found[PlanReport]][:2] == [("solved", "external"), ("solved", "suffix")]


@pytest.mark.xdist_group("live")
def test_a_planner_that_hangs_costs_its_limit_but_no_tick_and_leaves_no_process(tmp_path):
    marker = tmp_path / "pids"
    stuck = tmp_path / "stuck.py"
    stuck.write_text(
        "import os, subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(300)'])\n"
        f"open({str(marker)!r}, 'w').write(f'{{os.getpid()}} {{child.pid}}')\n"
        "while True: pass\n"
    )
    found = run_with(tmp_path, f"{sys.executable} {stuck}", limit_s=1.5)
    (answer,) = found[PlanAnswer]
    assert answer.outcome == "timeout"
    asked_s = (answer.stamp_ns - found[PlanRequest][0].stamp_ns) / 1e9
    assert 1.5 <= asked_s < 2.0
    assert [(plan.status, plan.way) for plan in found[PlanReport]][:2] == [
        ("failed", "external"),
        ("solved", "searched"),
    ]
    assert "planner failed: timeout: the planner was killed after 1.5 s; our own planner takes over" in found["screen"]
    waiting = [tick for tick in found[TickReport] if tick.stamp_ns <= answer.stamp_ns]
    assert sum(tick.skipped for tick in waiting) == 0
    assert len(waiting) >= 15
    assert max(tick.control_ns for tick in waiting) < 50e6
    assert all(command.v == 0.0 for command in found[VelocityCommand] if command.stamp_ns < answer.stamp_ns)
    assert all(gone(int(pid)) for pid in marker.read_text().split())
