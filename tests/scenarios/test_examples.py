"""Every example runs from any folder and prints its answer."""

import subprocess
import sys

import pytest

from tests.support.bus_system import ROOT

PRINTED = {
    "plan.py": "4:(put cup1 table2)",
    "predict_duration.py": "standard deviation",
    "read_recording.py": "dribbleBall: done",
    "refine_sequence.py": "refined",
    "run_lockstep.py": "achieved in",
}
ELSEWHERE = {"rover_driver.py", "gymnasium_policies.py"}  # tests/e2e/hardware, tests/unit/tools/gym


def test_every_example_is_tested():
    assert {path.name for path in (ROOT / "examples").glob("*.py")} == set(PRINTED) | ELSEWHERE


@pytest.mark.parametrize("name", PRINTED)
def test_example_prints_its_answer(name, tmp_path):
    script = [sys.executable, "-P", "-W", "error::RuntimeWarning", ROOT / "examples" / name]
    done = subprocess.run(script, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert PRINTED[name] in done.stdout
    assert not done.stderr
