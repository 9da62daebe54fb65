"""Costs of one robot alone, and disturbances, in the comparison of runs."""

from dataclasses import replace
from unittest.mock import MagicMock

import pytest

from tailor.executive import domains
from tailor.schemas.messages.kitchen import KitchenObject, KitchenTruth
from tailor.tools.evaluations import task_runs
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.refinement.paired_outcomes import columns
from tailor.tools.lockstep.run import Run
from tailor.tools.lockstep.task_sampler import sampler_of

DONE = Outcome(1, "h1", True, 10.0, "achieved", (), (), (), (), False, 0.0, (), ())


def truth(v: float = 0.0, omega: float = 0.0, tilt: float = 0.0, held: str = "") -> KitchenTruth:
    cup = KitchenObject("cup1", 0.0, 0.0, 0.77, 0.0, tilt)
    return KitchenTruth(0, 0.0, 0.0, 0.0, v, omega, 0.0, held, objects=(cup,))


def kitchen_costs(*states: KitchenTruth) -> dict[str, float]:
    return dict(sampler_of(domains.load("kitchen")).further_costs(states))


def test_a_cup_that_tipped_counts_once_and_one_in_the_hand_does_not() -> None:
    assert kitchen_costs(truth(tilt=1.0), truth(tilt=1.2))["tipped_cups"] == 1
    assert kitchen_costs(truth(tilt=1.0, held="cup1"), truth(tilt=0.1))["tipped_cups"] == 0


def test_a_base_that_creeps_or_turns_on_the_spot_loses_time() -> None:
    states = (truth(), truth(v=0.05), truth(omega=0.5), truth(v=0.3), truth(v=-0.05))
    assert kitchen_costs(*states)["slow_s"] == pytest.approx(0.3)


def test_costs_of_one_robot_are_compared_over_all_pairs_also_failed_ones() -> None:
    tipped = replace(DONE, achieved=False, costs=Costs(0, 0.0, (), (("tipped_cups", 1.0),)))
    upright = replace(DONE, costs=Costs(0, 0.0, (), (("tipped_cups", 0.0),)))
    pairs = {
        ("one-cup", k): (upright, tipped if k == 0 else replace(upright, duration_s=9.0 - 0.1 * k)) for k in range(4)
    }
    row = columns(pairs)
    assert (row["n"], row["tipped_cups_greedy"], row["tipped_cups_refined"]) == (3, 0.0, 0.25)


def test_a_disturbed_scenario_is_evaluated_with_its_disturbance(monkeypatch) -> None:
    worlds, limits_s = [], []

    def run(_, world, *, limit_s):
        worlds.append(world)
        limits_s.append(limit_s)
        return Run()

    monkeypatch.setattr(task_runs, "run_lockstep", run)
    monkeypatch.setattr(task_runs, "body_of", lambda *_: MagicMock())
    for scenario in ("one-cup", "moved-cup"):
        task_runs.run_task(Task("kitchen", scenario), Variant("h2"), 5)
    undisturbed, disturbed = worlds
    assert undisturbed.events == ()
    assert {name[:4] for event in disturbed.events for name in event.place} == {"cup1"}
    assert min(limits_s) > 120
