"""The benchmark's cases that are drawn as the executive meets them."""

from __future__ import annotations

import pytest

from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.refinement import decisions
from tailor.tools.benchmarks.refinement.refine import DECISIONS


@pytest.mark.parametrize(("domain", "scenario"), DECISIONS)
def test_a_first_decision_is_the_whole_plan_with_all_its_free_parameters(domain, scenario):
    models, case = decisions.first_decision(domain, scenario, 5000)
    objective = case.objective(models)
    used = {i for action in case.actions for i in action.variables}
    assert len(case.actions) == 4
    assert objective.ranges.count == len([v for v in case.variables if v.value is None and v.id in used]) == 10
    assert objective(objective.vectors(case.starts)).min() < float("inf")


def test_a_scenario_without_a_decision_in_time_is_no_measurement(monkeypatch):
    monkeypatch.setattr(decisions, "DECISION_S", 0.1)
    with pytest.raises(NoMeasurement, match="nothing is decided within"):
        decisions.first_decision("kitchen", "one-cup", 5000)
