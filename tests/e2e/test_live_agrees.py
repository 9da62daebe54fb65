"""Live runs over the bus end as lock-step's do, start by start: the evaluation with its real processes."""

from __future__ import annotations

import json
import subprocess

import pytest

from tailor.runtime.processes.child import tailor
from tests.support.bus_system import ROOT
from tests.support.patience import PATIENCE_S

STARTS = 2


@pytest.mark.slow
@pytest.mark.xdist_group("live")
def test_two_starts_live_and_in_lockstep_reach_the_goal_alike(tmp_path):
    flags = ("--episodes", STARTS, "--repeats", 5, "--store", tmp_path / "store", "--report", tmp_path, "--json")
    argv = tailor("evaluate", "live", *map(str, (*flags, "--recordings", tmp_path / "runs")))
    done = subprocess.run(argv, capture_output=True, text=True, timeout=5 * PATIENCE_S, cwd=ROOT)
    live, once_more = json.loads(done.stdout)["rows"]
    assert live["n"] == once_more["n"] == STARTS, done.stderr
    assert live["achieved_pct"] == live["achieved_lockstep_pct"] == 100
    assert abs(live["difference_pct"]) < 40  # two starts say little; that the clock is the same one
    assert len(list((tmp_path / "runs").glob("*.mcap"))) == STARTS
    assert (tmp_path / "live.html").exists()
    assert (tmp_path / "index.html").exists()
    again = subprocess.run(argv, capture_output=True, text=True, timeout=PATIENCE_S, cwd=ROOT)
    assert json.loads(again.stdout)["rows"] == [live, once_more]  # from the store, without a run
