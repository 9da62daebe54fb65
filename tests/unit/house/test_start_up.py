"""Commands load no slow library that they do not use, and a tick loads no module."""

import subprocess
import sys

import pytest

from tailor.tools.main import COMMANDS
from tests.support.bus_system import ROOT

HEAVY = {"scipy", "sklearn", "pandas", "matplotlib", "mujoco", "plotly", "onnx", "skl2onnx", "pytest"}
WITHOUT = {
    "main": {*HEAVY, "numpy", "rich", "onnxruntime", "zenoh", "rosbags", "mcap", "executive"},
    "info": {*HEAVY, "onnxruntime", "zenoh", "executive"},
    "recover": {*HEAVY, "onnxruntime", "zenoh", "executive"},
    "cut": {*HEAVY, "onnxruntime", "zenoh", "executive"},
    "verify": {*HEAVY, "zenoh", "rich"},
    "why": {*HEAVY, "zenoh"},
    "replay": {*HEAVY, "onnxruntime", "executive"},
    "record": {*HEAVY, "onnxruntime", "executive"},
    "bus": {*HEAVY, "onnxruntime", "executive", "cryptography"},
    "gateway": {*HEAVY, "onnxruntime", "executive", "cryptography"},
    "estop": {
        *HEAVY,
        "onnxruntime",
        "executive",
        "numpy",
        "rosbags",
        "rich",
        "mcap",
        "asyncio",
        "robots",
        "cryptography",
    },
    "arm": {*HEAVY, "onnxruntime", "executive"},
    "status": {*HEAVY, "onnxruntime", "executive"},
    "goal": {*HEAVY, "onnxruntime", "executive", "numpy", "rosbags"},
    "sim": {*HEAVY, "onnxruntime"},
    "up": {*HEAVY, "onnxruntime", "cryptography"},
}


def modules_of(module):
    """Names of the modules that a new process has loaded after importing one."""
    code = f"import sys, {module}; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert module in loaded.split()
    return set(loaded.split())


@pytest.mark.parametrize("name", WITHOUT)
def test_a_command_loads_nothing_heavy_that_it_does_not_need(name):
    loaded = modules_of("tailor.tools.main" if name == "main" else COMMANDS[name][0])
    assert {name.removeprefix("tailor.").split(".")[0] for name in loaded} & WITHOUT[name] == set()


@pytest.mark.parametrize("name", ["estop", "arm", "sim", "executive"])
def test_a_client_of_the_bus_loads_no_rules_of_its_router(name):
    assert "tailor.runtime.bus.rights.access" not in modules_of(COMMANDS[name][0])


RUN = """
import sys
from pathlib import Path
from tailor.executive.replay import replay
from tailor.tools.commands.look import verify
runs = verify.RecordedRuns(Path(sys.argv[1]))
context = verify.rebuild_context(runs.runs[0].provenance)
before = set(sys.modules)
assert sum(1 for _ in replay(context, runs.ticks(runs.runs[0]))) > 30
print(*sorted(set(sys.modules) - before))
"""


@pytest.mark.parametrize("name", ["soccer-approach-dribble", "soccer-kicked-ball", "arm-word-I"])
def test_no_tick_loads_a_module(name):
    """An import delays a live tick: numpy.ma alone, which np.unique loads, takes 40 ms."""
    golden = ROOT / "tests" / "data" / "golden" / f"{name}.mcap"
    command = [sys.executable, "-c", RUN, str(golden)]
    assert subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout.split() == []
