"""A short soak of the whole: strangers are refused, people stop and arm the robot, processes come back."""

from __future__ import annotations

import json
import subprocess

import pytest

from tailor.runtime.processes.child import tailor

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("live")]


@pytest.mark.parametrize("faults", ["stranger", "e-stop", "killed"])
def test_a_minute_of_faults_violates_nothing(tmp_path, faults):
    flags = ("--minutes", "1", "--every", "15", "--only", faults, "--output", str(tmp_path / "soak.json"))
    completed = subprocess.run(tailor("bench", "soak", *flags), capture_output=True, text=True, timeout=300)
    assert completed.returncode == 0, completed.stdout + completed.stderr
    content = json.loads((tmp_path / "soak.json").read_text())
    assert content["passed"]
    assert len(content["records"]) == 4
    assert all(record["refused"] for record in content["records"] if faults == "stranger")
