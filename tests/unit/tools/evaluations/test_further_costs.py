"""Rows of the comparison of runs: costs of one robot alone, disturbances, and few scenarios.

A row over few scenarios concludes nothing about others: no interval, no p-value, and no part in the exit code.
"""

from dataclasses import replace
from unittest.mock import MagicMock

import pytest

from tailor.executive import domains
from tailor.schemas.messages.kitchen import KitchenObject, KitchenTruth
from tailor.simnodes.b21.body import B21Body
from tailor.tools.evaluations import task_runs
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.refinement import refinement
from tailor.tools.evaluations.refinement.paired_outcomes import columns, is_better
from tailor.tools.lockstep.run import Run
from tailor.tools.lockstep.task_sampler import sampler_of
from tailor.tools.main import main

DONE = Outcome(1, "h1", True, 10.0, "achieved", (), (), (), (), False, 0.0, (), ())
BOTH = replace(DONE, costs=Costs(0, 5.0, ()))


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

    def run(_, world, *, limit_s, **_given):
        worlds.append(world)
        limits_s.append(limit_s)
        return Run()

    monkeypatch.setattr(task_runs, "run_lockstep", run)
    monkeypatch.setattr(task_runs, "body_of", lambda *_: MagicMock(names=B21Body.names))
    for scenario in ("one-cup", "moved-cup"):
        task_runs.run_task(Task("kitchen", scenario), Variant("h2"), 5)
    undisturbed, disturbed = worlds
    assert undisturbed.events == ()
    assert {name[:4] for event in disturbed.events for name in event.place} == {"cup1"}
    assert min(limits_s) > 120


def outcomes(*scenarios, starts=20, faster=0.1):
    def refined(number, k):
        costs = Costs(0, 5.0 + 0.01 * (k % 3) + 0.1 * number**2, ())
        return replace(BOTH, duration_s=10.0 - 10.0 * faster - 0.01 * (k % 5) - 0.1 * number**2, costs=costs)

    return {(name, k): (BOTH, refined(n, k)) for n, name in enumerate(scenarios) for k in range(starts)}


def inferred(row):
    return {name for name in row if name.startswith("p_") or name.endswith(("ci95", "_p"))}


def test_two_scenarios_have_a_mean_and_no_interval():
    row = columns(outcomes("one", "two"), "scenario")
    assert (row["n"], row["units"]) == (40, 2)
    assert row["improvement_pct"] == pytest.approx(10.7)
    assert {"mean_greedy_s", "energy_j_greedy", "failures_pct_refined", "slower_pct"} <= row.keys()
    assert inferred(row) == set()


@pytest.mark.parametrize(("scenarios", "unit"), [(("one", "two", "three"), "scenario"), (("one",), "start")])
def test_three_scenarios_and_the_starts_of_one_have_intervals(scenarios, unit):
    assert {"ci95", "p_value", "p_wilcoxon", "energy_j_more_ci95", "energy_j_p"} <= inferred(
        columns(outcomes(*scenarios), unit)
    )


def test_a_row_without_an_interval_is_judged_by_its_costs_alone():
    row = columns(outcomes("one", "two"), "scenario")
    assert is_better(row)
    assert not is_better({**row, "contacts_pct_refined": row["contacts_pct_greedy"] + 1.0})
    assert not is_better(columns(outcomes("one", faster=-0.1)))


@pytest.mark.parametrize(("scenarios", "remarked"), [(["aligned", "approach"], True), (["approach"], False)])
def test_the_report_states_why_and_the_exit_code_follows_rows_of_scenarios(monkeypatch, capsys, scenarios, remarked):
    def rows_of(domain, names, seeds, arguments):
        rows = [{"scenario": name, "horizon": 2, **columns(outcomes(name))} for name in names]
        together = (
            {"scenario": "all", "horizon": 2, **columns(outcomes(*names), "scenario")} if len(names) > 1 else None
        )
        return [*rows, *([together] if together else [])], {}

    monkeypatch.setattr(refinement, "rows_of", rows_of)
    command = ["evaluate", "refinement", "--domain", "soccer", "--episodes", "20", "--scenario", *scenarios]
    assert main(command) == 0
    assert ("fewer than 3 units" in capsys.readouterr().out) is remarked
