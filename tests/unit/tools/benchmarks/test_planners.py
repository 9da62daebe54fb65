"""Benchmarks of planning: problems solved by configuration, anytime improvements, share of a tick."""

import pytest

from tailor.executive.deliberation.plan_source import PlanSource
from tailor.executive.planning import DEFAULT, MATCHING
from tailor.tools.benchmarks.planners import balls, configurations, cups, improvement, tick_share, tours
from tailor.tools.benchmarks.planning import texts


def test_more_plans_solve_more_and_both_engines_the_most(monkeypatch):
    monkeypatch.setattr(configurations, "names", lambda: ["kitchen-s1", "kitchen-s3"])
    monkeypatch.setattr(configurations, "CUPS", (6,))
    assert [configurations.solved(MATCHING, limit) for limit in (10, 50, 3000)] == [0, 1, 2]
    assert configurations.solved(DEFAULT, 3000) == 3


def test_makespans_shrink_as_work_grows():
    measure, found, _ = improvement.improvements(*texts("kitchen-durative-s3"), 1000)
    assert measure == "makespan"
    assert [round(each.value, 2) for each in found] == [56.08, 28.04]
    assert 0 < found[0].generated < found[1].generated
    assert 0 < found[0].cpu_s < found[1].cpu_s


def test_costs_of_the_kitchen_are_minimised():
    measure, found, _ = improvement.improvements(*improvement.with_costs(*texts("kitchen-s2")), 1000)
    assert measure == "cost"
    assert found[-1].value == 4 * 5 + 4


def test_planning_takes_its_share_of_the_first_ticks_and_the_method_is_restored():
    real = PlanSource.advance
    shared = tick_share.shares("soccer", "approach-dribble", 4.0)
    assert PlanSource.advance is real
    assert len(shared) > 20
    assert max(shared) > 0
    assert sorted(shared)[len(shared) // 2] == pytest.approx(0, abs=2), "most ticks plan nothing"


def test_errands_take_each_cup_from_its_table_on_the_map_to_another():
    drawn = [cups.errands(seed) for seed in range(40)]
    assert all(spots["from1"] == ("table1", 0) and spots["from2"] == ("table3", 2) for spots in drawn)
    assert {(spots["to1"][0], spots["to2"][0]) for spots in drawn} == {
        (one, other) for one in ("table2", "table3") for other in ("table1", "table2")
    }
    assert all(len(set(spots.values())) == 4 for spots in drawn), "each place is another slot"


@pytest.mark.slow
def test_two_errands_in_the_kitchen_are_done_in_the_order_that_the_models_choose():
    run = cups.driven(1, "models")
    assert run.achieved
    assert len(run.finished) == 12


@pytest.mark.slow
def test_a_tour_chosen_by_the_models_is_driven_faster():
    by_steps, by_models = tours.driven(1, "steps"), tours.driven(1, "models")
    assert by_steps.achieved
    assert by_models.achieved
    assert by_models.duration_s < by_steps.duration_s


@pytest.mark.slow
@pytest.mark.parametrize("costs", ["steps", "models"])
def test_a_ball_is_brought_to_the_target_whichever_way_it_is_chosen(costs):
    assert balls.driven(100, costs).achieved
