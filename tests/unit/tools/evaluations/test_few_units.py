"""A row over few scenarios concludes nothing about others: no interval, no p-value, and no part in the exit code."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.evaluations.refinement import refinement
from tailor.tools.evaluations.refinement.paired_outcomes import columns, is_better
from tailor.tools.main import main

DONE = Outcome(1, "h1", True, 10.0, "achieved", (), (), (), (), False, 0.0, (), (), costs=Costs(0, 5.0, ()))


def pairs(*scenarios, starts=20, faster=0.1):
    def refined(number, k):
        costs = Costs(0, 5.0 + 0.01 * (k % 3) + 0.1 * number**2, ())
        return replace(DONE, duration_s=10.0 - 10.0 * faster - 0.01 * (k % 5) - 0.1 * number**2, costs=costs)

    return {(name, k): (DONE, refined(n, k)) for n, name in enumerate(scenarios) for k in range(starts)}


def inferred(row):
    return {name for name in row if name.startswith("p_") or name.endswith(("ci95", "_p"))}


def test_two_scenarios_have_a_mean_and_no_interval():
    row = columns(pairs("one", "two"), "scenario")
    assert (row["n"], row["units"]) == (40, 2)
    assert row["improvement_pct"] == pytest.approx(10.7)
    assert {"mean_greedy_s", "energy_j_greedy", "failures_pct_refined", "slower_pct"} <= row.keys()
    assert inferred(row) == set()


@pytest.mark.parametrize(("scenarios", "unit"), [(("one", "two", "three"), "scenario"), (("one",), "start")])
def test_three_scenarios_and_the_starts_of_one_have_intervals(scenarios, unit):
    assert {"ci95", "p_value", "p_wilcoxon", "energy_j_more_ci95", "energy_j_p"} <= inferred(
        columns(pairs(*scenarios), unit)
    )


def test_a_row_without_an_interval_is_judged_by_its_costs_alone():
    row = columns(pairs("one", "two"), "scenario")
    assert is_better(row)
    assert not is_better({**row, "contacts_pct_refined": row["contacts_pct_greedy"] + 1.0})
    assert not is_better(columns(pairs("one", faster=-0.1)))


@pytest.mark.parametrize(("scenarios", "told"), [(["aligned", "approach"], True), (["approach"], False)])
def test_the_report_tells_why_and_the_exit_code_follows_the_rows_of_the_scenarios(monkeypatch, capsys, scenarios, told):
    def rows_of(domain, names, seeds, arguments):
        rows = [{"scenario": name, "horizon": 2, **columns(pairs(name))} for name in names]
        together = {"scenario": "all", "horizon": 2, **columns(pairs(*names), "scenario")} if len(names) > 1 else None
        return [*rows, *([together] if together else [])], {}

    monkeypatch.setattr(refinement, "rows_of", rows_of)
    command = ["evaluate", "refinement", "--domain", "soccer", "--episodes", "20", "--scenario", *scenarios]
    assert main(command) == 0
    assert ("fewer than 3 units" in capsys.readouterr().out) is told
