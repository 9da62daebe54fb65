"""A soak that measured nothing fails; lateness in a stall of the machine is excused, motion never."""

from __future__ import annotations

import pytest

from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.soak import check_measured
from tailor.tools.soak.faults.scene import FaultRecord
from tailor.tools.soak.judging.violations import Invariant, Violation
from tailor.tools.soak.report import fault_rows

MEASURED = {"ticks": 10, "commands": 9, "motion_s": 3.0}


def record(name="executive killed", **values):
    return FaultRecord(name, 1, "agilo", 1.0, 1, moving=True, **values)


def test_a_soak_that_measured_something_passes():
    check_measured({"systems": {"agilo": MEASURED}, "records": [{}]})


@pytest.mark.parametrize("missing", MEASURED)
def test_a_system_without_ticks_commands_or_motion_measured_nothing(missing):
    systems = {"agilo": MEASURED, "powercube": {**MEASURED, missing: 0}}
    with pytest.raises(NoMeasurement, match=f"powercube has no {missing}"):
        check_measured({"systems": systems, "records": [{}]})


def test_a_soak_without_a_fault_measured_nothing():
    with pytest.raises(NoMeasurement, match="no fault"):
        check_measured({"systems": {"agilo": MEASURED}, "records": []})


@pytest.mark.parametrize("invariant", Invariant)
def test_only_lateness_is_excused_by_a_stall(invariant):
    late = invariant.name.endswith("_IN_TIME") or invariant is Invariant.TASK_GOES_ON
    assert Violation(1.0, "agilo", invariant, "", "", 0.2).excused == late
    assert not Violation(1.0, "agilo", invariant, "", "", 0.05).excused


def test_faults_are_counted_by_kind_with_their_worst_times():
    rows = fault_rows([record(zero_s=0.2), record(zero_s=0.3, back_s=1.0), record("e-stop", zero_s=0.1)])
    assert [(row["fault"], row["count"], row["worst_zero_s"], row["worst_back_s"]) for row in rows] == [
        ("e-stop", 1, 0.1, None),
        ("executive killed", 2, 0.3, 1.0),
    ]
