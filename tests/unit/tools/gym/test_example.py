"""The example that compares policies: chance is worse than the controller of the action."""

import re
import subprocess
import sys

import pytest

from tests.support.bus_system import ROOT


@pytest.mark.parametrize("env_id", ["tailor-action/arm-v0"])
def test_the_controller_is_faster_than_chance(env_id):
    command = [sys.executable, ROOT / "examples" / "gymnasium_policies.py", env_id]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
    returns = {name: float(value) for name, value in re.findall(r"^(\w+) +(-[\d.]+)$", printed, re.MULTILINE)}
    assert -5.0 < returns["controller"] < 0.0
    assert returns["chance"] < returns["controller"] - 5.0
    assert len(returns) == 3
