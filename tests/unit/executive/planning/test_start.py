"""A planner starts quickly: it loads only what a search uses."""

import subprocess
import sys

import pytest

from tailor.executive import planning
from tests.support.planning.planning_problems import DATA

FILES = [str(DATA / "own" / f"soccer-{part}.pddl") for part in ("domain", "p1")]
SLOW = ("numpy", "matplotlib", "multiprocessing", "difflib", "tailor.tools.figures")
UNUSED = ("lifted", "anytime", "forward.deordering", "ground.reachability")  # by a short problem


def test_a_plan_is_printed_without_loading_slow_modules():
    code = "import sys; from tailor.tools.main import main; main(); print(*sys.modules, sep=chr(10))"
    run = subprocess.run([sys.executable, "-c", code, "plan", *FILES], capture_output=True, text=True, check=True)
    assert "2:(dribbleball pos2 pos3)" in run.stdout
    needless = SLOW + tuple(f"tailor.executive.planning.{name}" for name in UNUSED)
    assert [name for name in run.stdout.split() if name.startswith(needless)] == []


def test_every_public_name_is_found():
    for name in planning.__all__:
        assert getattr(planning, name) is not None
    assert set(planning._MODULES) == set(planning.__all__)
    with pytest.raises(AttributeError, match="nothing"):
        _ = planning.nothing
