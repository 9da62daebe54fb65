"""Starts at which the goal holds: no action, so no duration; they must not turn the figures of all others into NaN."""

import math
from dataclasses import replace

import pytest

from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.refinement.ablations import Judged, row
from tailor.tools.evaluations.refinement.paired_outcomes import columns
from tailor.tools.evaluations.task_runs import run_one
from tests.unit.tools.evaluations.test_refinement_evaluations import DONE

NOTHING = replace(DONE, duration_s=math.nan, actions=(), outcomes=(), predicted_s=(), actual_s=())
DURATIONS_S = ((10.0, 9.0), (12.0, 10.0), (11.0, 10.5))


def test_a_run_without_anything_to_do_has_no_duration():
    outcome = run_one(Task("soccer", "approach-dribble", goal="(robot pos1)"), Variant("h1"), 3)
    assert (outcome.achieved, outcome.actions) == (True, ())
    assert math.isnan(outcome.duration_s)


@pytest.mark.parametrize("unit", ["start", "scenario"])
def test_a_start_at_the_goal_leaves_the_durations_of_the_others(unit):
    others = {
        (name, k): (replace(DONE, duration_s=greedy), replace(DONE, duration_s=refined))
        for name in ("dock", "pipes", "shelf")
        for k, (greedy, refined) in enumerate(DURATIONS_S)
    }
    expected, found = columns(others, unit), columns({**others, ("pipes", 9): (NOTHING, NOTHING)}, unit)
    times = ("n", "units", "mean_greedy_s", "improvement_pct", "ci95", "p_value", "total_pct", "slower_pct", "failed")
    assert {key: found[key] for key in times} == {key: expected[key] for key in times}
    assert math.isfinite(found["improvement_pct"])


def test_an_ablation_leaves_it_out_too():
    greedy, default = (
        {k: replace(DONE, duration_s=pair[side]) for k, pair in enumerate(DURATIONS_S)} for side in (0, 1)
    )
    expected = row("x", Judged(greedy, default, default))
    found = row("x", Judged({**greedy, 7: NOTHING}, {**default, 7: NOTHING}, {**default, 7: NOTHING}))
    assert found == expected
