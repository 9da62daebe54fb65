"""Evaluations of refinement: the paper's statistics, episodes kept over a break, baselines told apart."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from tailor.executive.interfaces.domain import LabelQuery
from tailor.executive.interfaces.values import Interval
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations import catalogue
from tailor.tools.evaluations.assertion import figure15, figure16
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.journal import Journal
from tailor.tools.evaluations.live import live
from tailor.tools.evaluations.models import learning_curves
from tailor.tools.evaluations.oracles import grid
from tailor.tools.evaluations.oracles.baselines import against_oracle
from tailor.tools.evaluations.oracles.grid import _judged, _values, subgoal_parameters
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.pages.plots import draw_pairs
from tailor.tools.evaluations.paired_comparison import compare, share_interval
from tailor.tools.evaluations.pinned import PinnedDomain
from tailor.tools.evaluations.refinement import (
    ablations,
    energy,
    figure1,
    figure11,
    refinement,
    refinement_rows,
    replicas,
    table3,
    table4,
)
from tailor.tools.evaluations.refinement.paired_outcomes import columns, is_better
from tailor.tools.evaluations.seeds import Seeds
from tailor.tools.evaluations.task_runs import paired, run_one
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.making.episodes import gather_random
from tailor.tools.learning.recipe_file import read_recipe, recipe_path
from tailor.tools.main import main

COSTS = [f"{cost}_pct_{who}" for cost in ("failures", "contacts") for who in ("greedy", "refined")]
DONE = Outcome(
    seed=1,
    variant="h1",
    achieved=True,
    duration_s=10.0,
    result="achieved",
    actions=("approachBall", "dribbleBall"),
    outcomes=("done", "done"),
    predicted_s=(4.0, 5.0),
    actual_s=(4.0, 6.0),
    asserted=False,
    disturbance_m=0.0,
    free=(("pos2", "phi", -3.0, 3.0, 0.5), ("subgoal12", "x", -3.0, 3.0, 1.0)),
    bound=(("pos1", "x", 0.0),),
    costs=Costs(0, 5.0, (("position_m", 0.05),)),
)


def test_improvement_is_the_mean_of_the_paired_ratios():
    said = compare([10.0, 20.0, 10.0, 10.0], [9.0, 10.0, 11.0, 10.0])
    assert (said.n, said.units) == (4, 4)
    assert said.improvement_pct == pytest.approx(100 * np.mean([0.1, 0.5, -0.1, 0.0]))
    assert said.slower_pct == 25.0
    assert said.ci95[0] < said.improvement_pct < said.ci95[1]


def test_no_difference_is_not_significant():
    said = compare([10.0, 12.0], [10.0, 12.0])
    assert (said.improvement_pct, said.p_value, said.p_wilcoxon) == (0.0, 1.0, 1.0)


def test_unequal_or_single_pairs_are_refused():
    with pytest.raises(UsageError, match="1 episodes to compare, expected two"):
        compare([1.0], [1.0])
    with pytest.raises(ValueError, match="expected as many"):
        compare([1.0, 2.0], [1.0])


def test_share_of_nothing_is_unknown():
    assert share_interval(0, 0) == (0.0, 100.0)
    low, high = share_interval(98, 100)
    assert low < 98 < high


def test_only_episodes_that_both_reached_the_goal_are_paired():
    failed = replace(DONE, seed=2, achieved=False)
    assert paired({1: DONE, 2: DONE}, {1: replace(DONE, duration_s=9.0), 2: failed}) == ([10.0], [9.0])


def test_finished_episodes_survive_a_break_and_a_torn_line(tmp_path):
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    next(tmp_path.iterdir()).open("a").write('{"seed": 2, "vari')
    again = Journal(tmp_path, task, variant, ["a"])
    assert again.known == {1: DONE}
    again.note(replace(DONE, seed=3))
    assert sorted(Journal(tmp_path, task, variant, ["a"]).known) == [1, 3]


WHOLE = json.dumps(asdict(DONE)).encode()


@pytest.mark.parametrize(
    "damage",
    [
        b'{"seed": 5}\n',
        b"[1, 2]\n",
        b"7\n",
        b'\xff\xfe"\n',
        b"[" * 100_000 + b"\n",
        WHOLE.replace(b'"seed": 1', b'"seed": {}') + b"\n",
        WHOLE.replace(b'"seed": 1', b'"seed": 2').replace(b'"duration_s": 10.0', b'"duration_s": null') + b"\n",
    ],
)
def test_a_damaged_line_costs_its_own_episode_and_no_other(tmp_path, damage):
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    path = next(tmp_path.iterdir())
    path.write_bytes(damage + path.read_bytes())
    assert Journal(tmp_path, task, variant, ["a"]).known == {1: DONE}


def test_a_truncated_line_is_ended_without_writing_the_others_anew(tmp_path, monkeypatch):
    """A full disk or a kill would lose them, and another command may just write there, too."""
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    path = next(tmp_path.iterdir())
    path.open("a").write('{"seed": 2, "vari')
    whole, before = path.stat().st_ino, path.read_bytes()

    def full(*_, **__):
        path.write_bytes(b"")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(type(path), "write_text", full)
    Journal(tmp_path, task, variant, ["a"])
    assert (path.stat().st_ino, path.read_bytes()) == (whole, before + b"\n")


def test_a_full_disk_is_reported_with_the_file_of_the_store():
    journal = Journal(None, Task("soccer", "approach-dribble"), Variant("h1"), ["a"])
    journal._path = Path("/dev/full")
    with pytest.raises(UsageError, match=r"^/dev/full: No space left on device, expected a file that can be written"):
        journal.note(DONE)


def test_a_horizon_that_is_named_twice_is_run_once(tmp_path, monkeypatch, capsys):
    seen = []
    monkeypatch.setattr(refinement, "rows_of", lambda *settings: seen.append(settings[-1].horizon) or ([], {}))
    words = ["evaluate", "refinement", "--domain", "arm", "--scenario", "letter-I", "--horizon", "3", "2", "3"]
    assert main([*words, "--store", str(tmp_path)]) == 0
    assert seen == [[3, 2]]


def test_settings_are_those_of_greedy_and_refined_runs(tmp_path, monkeypatch, capsys):
    seen: list[Variant] = []

    def run_all(task, variants, seeds, *_):
        seen.extend(variants)
        return {v.name: {seed: replace(DONE, seed=seed, variant=v.name) for seed in seeds} for v in variants}

    monkeypatch.setattr(refinement_rows, "run_all", run_all)
    words = ["evaluate", "refinement", "--domain", "arm", "--scenario", "letter-I", "--episodes", "3"]
    main([*words, "--store", str(tmp_path), "--refinement", "risk_cost_s=20", "p_fail_max=0.15"])
    assert [(v.refinement.horizon, v.refinement.risk_cost_s, v.refinement.p_fail_max) for v in seen] == [
        (1, 20.0, 0.15), (2, 20.0, 0.15)
    ]  # fmt: skip
    assert "settings of refinement: risk_cost_s=20, p_fail_max=0.15" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("risk_cost_s=-1", "risk_cost_s is -1"),
        ("risk_cost_s=much", "--refinement 'risk_cost_s=much', expected KEY=VALUE"),
        ("risk_cost_s", "--refinement 'risk_cost_s', expected KEY=VALUE"),
        ("price=3", "price"),
        ("patience=1.5", "patience"),
        ("horizon=3", "of refined ones --horizon H"),
    ],
)
def test_settings_that_there_are_not_are_refused_before_anything_runs(word, message, monkeypatch, capsys):
    monkeypatch.setattr(refinement, "rows_of", lambda *_: pytest.fail("runs"))
    assert main(["evaluate", "refinement", "--domain", "arm", "--refinement", word]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line


def test_the_largest_weight_of_energy_is_judged_wherever_it_is_named(monkeypatch, capsys, tmp_path):
    def cost(_, weight, seed):
        return energy.Cost(True, 10.0 + weight, (9.0 if weight == 1.0 else 8.0 - weight) + 0.1 * (seed % 7))

    monkeypatch.setattr(energy, "cost_of", cost)
    words = ["evaluate", "energy", "--episodes", "5", "--jobs", "1", "--store", str(tmp_path), "--weights", "0", "3"]
    assert main([*words, "1"]) == main(words) == 0


def test_other_models_or_settings_are_other_episodes(tmp_path):
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    assert Journal(tmp_path, task, variant, ["b"]).known == {}
    other = replace(variant, refinement=replace(variant.refinement, k_std=2.0))
    assert Journal(tmp_path, task, other, ["a"]).known == {}


def test_pin_binds_what_is_free_and_nothing_else():
    class Inner:
        name = "inner"

        def value(self, query):
            return {"x": Interval(1.0, 1.0), "v": Interval(0.0, 0.3)}.get(query.quantity)

    domain = PinnedDomain(Inner(), {("pos2", "v"): 0.1, ("pos2", "x"): 5.0, ("pos2", "phi"): 2.0})

    def value(quantity, label):
        return domain.value(LabelQuery(quantity, label, (), (), None, None))

    assert value("v", "pos2") == Interval(0.1, 0.1)
    assert value("phi", "pos2") == Interval(2.0, 2.0)
    assert value("x", "pos2") == Interval(1.0, 1.0)
    assert value("v", "pos3") == Interval(0.0, 0.3)
    assert domain.name == "inner"


def test_oracle_tells_ceiling_greedy_and_zero_apart():
    slow_start = replace(DONE, duration_s=8.0, actual_s=(5.0, 3.0))
    quick_start = replace(DONE, duration_s=12.0, actual_s=(3.0, 9.0))
    failed = replace(DONE, achieved=False, duration_s=1.0)
    said = _judged(1, [slow_start, quick_start, failed], DONE)
    assert (said.ceiling_s, said.greedy_s, said.zero_s) == (8.0, 12.0, 10.0)
    row = against_oracle([said], {1: DONE}, {1: replace(DONE, duration_s=9.0)})
    assert row["oracle_pct"] == pytest.approx(20.0)
    assert row["refined_same_starts_pct"] == pytest.approx(10.0)


@pytest.mark.filterwarnings("error")
def test_an_oracle_without_a_start_that_ends_well_both_ways_or_without_a_gain_is_a_result():
    failed = replace(DONE, achieved=False)
    row = against_oracle([_judged(1, [failed], failed)], {1: DONE}, {1: DONE})
    assert row["oracle_n"] == 0
    assert math.isnan(row["oracle_pct"])
    row = against_oracle([replace(_judged(1, [DONE], DONE), again_s=11.0)], {1: DONE}, {1: DONE})
    assert (row["oracle_n"], row["oracle_pct"]) == (1, 0.0)
    assert math.isnan(row["share_of_oracle_pct"])


def test_oracle_chooses_for_the_plan_not_for_subgoals():
    assert subgoal_parameters(DONE) == [("pos2", "phi", -3.0, 3.0)]
    assert len(_values(("pos2", "phi", -np.pi, np.pi), 12, True)) == 12
    assert _values(("pos2", "v", 0.0, 0.3), 12, False) == pytest.approx([0.0, 0.15, 0.3])


def test_assertion_is_counted_as_the_paper_counts_it():
    approach = replace(DONE, actions=("approachBall",), outcomes=("done",), predicted_s=(4.0,), actual_s=(4.0,))
    bumped = replace(approach, disturbance_m=0.2)
    with_subgoal = replace(approach, asserted=True, actual_s=(4.4,))
    before = {1: approach, 2: bumped, 3: approach, 4: approach}
    after = {1: approach, 2: with_subgoal, 3: with_subgoal, 4: replace(with_subgoal, actual_s=(4.8,))}
    row = figure16.summary(before, after)
    assert row["success_before_pct"] == 75.0
    assert row["success_after_pct"] == 100.0
    assert row["needless_pct"] == 50.0
    assert row["needless_slower_pct"] == pytest.approx(15.0)
    assert row["predicted_fail_observed_success_pct"] == 75.0


@pytest.mark.parametrize("module", [table3, table4, figure1, figure11, figure15, figure16, live])
def test_every_evaluation_has_the_same_flags(module):
    parser = argparse.ArgumentParser()
    module.configure(parser)
    given = parser.parse_args(["--episodes", "3", "--jobs", "1", "--json"])
    assert (given.episodes, given.jobs, given.json) == (3, 1, True)


@pytest.mark.parametrize("name", catalogue.EVALUATIONS)
def test_every_evaluation_can_be_one_of_the_lot(name):
    module, given, unknown = catalogue._parsed(name, ["--jobs", "1", "--report", "out", "--json", "--domain", "soccer"])
    assert (given.jobs, given.json, str(given.report), unknown) == (1, True, "out", [])
    assert callable(module.run)


@pytest.mark.parametrize("module", [table3, table4])
def test_unknown_scenario_is_a_usage_error(module):
    parser = argparse.ArgumentParser()
    module.configure(parser)
    with pytest.raises(UsageError, match="chess"):
        module.run(parser.parse_args(["--scenario", "chess"]))


@pytest.mark.parametrize("flag", ["--model-episodes", "--model-runs"])
def test_numbers_of_models_that_are_not_made_are_refused(flag, monkeypatch):
    """The figures of those that ship would pass for theirs."""
    monkeypatch.setattr(refinement, "rows_of", lambda *_: pytest.fail("runs"))
    parser = argparse.ArgumentParser()
    refinement.configure(parser)
    with pytest.raises(UsageError, match=f"{flag}: of the models that --models K makes"):
        refinement.run(parser.parse_args(["--domain", "soccer", "--episodes", "2", flag, "100"]))


@pytest.mark.parametrize("name", ["refinement", "table3", "table4"])
@pytest.mark.parametrize("flag", ["--points", "--oracle-runs"])
def test_flags_of_an_oracle_that_is_not_asked_for_are_refused_before_anything_runs(name, flag, monkeypatch, capsys):
    monkeypatch.setattr(refinement, "rows_of", lambda *_: pytest.fail("runs"))
    assert main(["evaluate", name, "--domain", "soccer", flag, "12"]) == 2
    assert capsys.readouterr().err == f"tailor evaluate: {flag}: of the oracle, expected none without --oracle N\n"


def test_the_row_over_models_has_an_interval_between_models():
    row = {"scenario": "soccer", "horizon": 2, "n": 100, "mean_greedy_s": 12.0, "mean_refined_s": 11.0}
    row |= {"slower_pct": 10.0, "contacts_pct_refined": 1.0}
    gains = (8.0, 9.0, 10.0)
    (over,) = replicas.over_models([{**row, "improvement_pct": gain, "total_pct": gain + 1} for gain in gains])
    assert (over["n"], over["improvement_pct"], over["least_pct"], over["most_pct"]) == (300, 9.0, 8.0, 10.0)
    assert over["ci95"] == pytest.approx((9 - 4.303 / np.sqrt(3), 9 + 4.303 / np.sqrt(3)), abs=0.01)
    assert (over["unit"], over["units"], over["contacts_pct_refined"]) == ("set of models", 3, 1.0)
    assert over["p_value"] == 0.004
    assert over["total_pct"] == 10.0
    assert over["total_ci95"] == pytest.approx((10 - 4.303 / np.sqrt(3), 10 + 4.303 / np.sqrt(3)), abs=0.01)


def test_scenarios_and_horizons_have_rows_of_their_own_over_models():
    row = {"n": 5, "slower_pct": 0.0, "improvement_pct": 9.0}
    kinds = [{**row, "scenario": s, "horizon": h} for s in ("a", "b") for h in (2, 3)]
    better = [{**kind, "improvement_pct": 10.0} for kind in kinds]
    assert len(replicas.over_models([*kinds, *better])) == 4
    assert replicas.over_models(kinds) == []


def test_no_two_replicas_share_a_seed_in_any_round(monkeypatch, tmp_path):
    monkeypatch.setattr(replicas, "show", lambda *_: None)
    seeds = []
    for number in range(1, 6):
        recipe = replicas.replica(replicas.Recipe("soccer"), number, tmp_path, 1).recipe
        seeds += [recipe.seed + step for step in range(len(recipe.rounds) + len(recipe.calibration))]
    assert len(set(seeds)) == len(seeds) > 5
    assert replicas.FIRST_SEED < min(seeds) < max(seeds) < learning_curves.FIRST_RECIPE_SEED


@pytest.mark.slow
def test_a_model_trained_anew_is_made_once_and_is_another_than_the_next(tmp_path):
    recipe = replicas.Recipe("soccer", (), 60, 0)
    first, second = (replicas.replica(recipe, number, tmp_path, 2).zoo for number in (1, 2))
    sums = [json.loads((zoo / "agilo/goToPose/duration.card.json").read_text())["sha256"] for zoo in (first, second)]
    assert sums[0] != sums[1]
    made = _files(tmp_path)
    assert replicas.replica(recipe, 1, tmp_path, 2).zoo == first
    assert _files(tmp_path) == made


def test_sets_of_models_of_fewer_episodes_follow_those_of_more(monkeypatch, tmp_path):
    """They were refused, and so was each set that was finished once one of more episodes had been begun."""
    monkeypatch.setattr(random_episodes, "gather", lambda *_: iter(()))  # folders and manifests alone
    monkeypatch.setattr(replicas, "make", gather_random)
    for count in (None, 300, 60, 300, None):
        made = replicas.replica(replicas.Recipe("soccer", ("waypoints",), count, 0), 1, tmp_path, 1)
        manifest = json.loads((made.random / "goToPose" / "manifest.json").read_text())
        assert manifest["episodes"] == made.recipe.episodes_of("goToPose")


def _files(folder):
    """When each was written; manifests are written every time."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "manifest.json")
    return {path: path.stat().st_mtime_ns for path in files}


def test_oracles_choice_is_executed_again_with_other_noise(monkeypatch):
    asked = []

    def run_all(task, variants, seeds, jobs, store, title):
        asked.extend(variants)
        took = {"again": 9.0}
        return {v.name: {s: replace(DONE, seed=s, duration_s=took.get(v.name.split("-")[0], 8.0 + abs(v.pins[0][2])))
                         for s in seeds} for v in variants}  # fmt: skip

    monkeypatch.setattr(grid, "run_all", run_all)
    free = [("pos2", "phi", -np.pi, np.pi)]
    (one,) = grid.simulate_choices(Task("soccer", "x"), free, [1], Variant("h2").refinement, 12, 1, None)
    again = [variant for variant in asked if variant.name.startswith("again")]
    assert {round(variant.pins[0][2], 9) for variant in again} == {0.0}
    assert len({variant.noise for variant in again}) == len(again) == 3
    assert all(variant.noise for variant in again)
    assert one.again_s == 9.0


def test_greedy_by_the_oracle_does_not_count_an_approach_that_failed_soon():
    failed_soon = replace(
        DONE, actions=("approachBall", *DONE.actions), outcomes=("failed", "done", "done"),
        actual_s=(1.0, 4.0, 6.0), duration_s=20.0,
    )  # fmt: skip
    assert _judged(1, [DONE, failed_soon], DONE).greedy_s == DONE.duration_s


def test_an_ablation_is_compared_with_the_default_pair_by_pair():
    def runs(*durations_s):
        return {seed: replace(DONE, seed=seed, duration_s=d) for seed, d in enumerate(durations_s)}

    greedy, default = runs(10.0, 20.0, 10.0), runs(9.0, 16.0, 8.0)
    row = ablations.row("x", ablations.Judged(greedy, default, runs(9.5, 18.0, 11.0)))
    assert row["improvement_pct"] == pytest.approx(np.mean([5.0, 10.0, -10.0]))
    assert row["improvement_more_points"] == pytest.approx(np.mean([-5.0, -10.0, -30.0]))
    assert row["improvement_more_ci95"][0] < row["improvement_more_points"] < row["improvement_more_ci95"][1]
    assert (row["slower_pct"], row["lost_s"]) == (pytest.approx(100 / 3), pytest.approx(1 / 3))
    same = ablations.row("default", ablations.Judged(greedy, default, default))
    assert (same["improvement_more_points"], same["improvement_more_p"]) == (0.0, 1.0)


def test_scenarios_have_starts_of_their_own(monkeypatch):
    """Those of one seed share noise and what the body draws; the row over all scenarios takes them for independent."""
    ran: dict[str, range] = {}

    def run_all(task, variants, seeds, *_):
        ran[task.scenario] = seeds
        return {variant.name: {seed: replace(DONE, seed=seed) for seed in seeds} for variant in variants}

    monkeypatch.setattr(refinement_rows, "run_all", run_all)
    given = argparse.Namespace(
        profile="", zoo="", episodes=4, horizon=[2], jobs=1, store=None, oracle=0, tick_ms=0.0, refinement=[]
    )
    rows, _ = refinement_rows.rows_of("arm", ["letter-A", "letter-B"], Seeds(100, {}), given)
    assert ran == {"letter-A": range(100, 104), "letter-B": range(104, 108)}
    assert [row["n"] for row in rows] == [4, 4, 8]


@pytest.mark.parametrize("achieved", [0, 1])
def test_a_scenario_that_nearly_always_fails_has_a_row_with_its_failures(achieved, tmp_path):
    failed = replace(DONE, achieved=False)
    pairs = {("a", seed): (DONE, DONE if seed < achieved else failed) for seed in range(4)}
    row = columns(pairs)
    assert (row["n"], row["failed"], row["failures_pct_refined"]) == (achieved, 4 - achieved, 100 - 25 * achieved)
    assert np.isnan([row["improvement_pct"], *row["ci95"]]).all()
    assert not is_better(row)
    durations_s = [DONE.duration_s] * achieved
    assert draw_pairs(durations_s, durations_s, tmp_path / "pairs.png").exists()


def test_the_gain_of_the_total_is_that_of_the_sums_with_an_interval_over_starts():
    took = 3 * ((10.0, 9.0), (20.0, 10.0), (10.0, 11.0), (10.0, 10.0))
    pairs = {("a", k): tuple(replace(DONE, duration_s=s) for s in pair) for k, pair in enumerate(took)}
    row = columns(pairs)
    assert row["total_pct"] == pytest.approx(20.0)
    assert row["total_ci95"][0] < 20.0 < row["total_ci95"][1]
    assert "total_ci95" not in columns({**pairs, ("b", 1): pairs["a", 1]}, "scenario")


def test_of_the_total_a_scenario_of_which_some_starts_failed_has_its_own_share():
    """The mean of a scenario with half as many pairs counted as much: 2 % of the total instead of 5."""
    faster, as_fast, failed = (
        tuple(replace(DONE, duration_s=s, achieved=s < 99) for s in pair) for pair in ((10, 9), (20, 20), (10, 99))
    )
    pairs = {("a", k): faster for k in range(8)} | {("b", k): as_fast if k < 2 else failed for k in range(8)}
    pairs |= {("c", k): as_fast if k < 2 else failed for k in range(8)}
    row = columns(pairs, "scenario")
    assert (row["n"], row["units"]) == (12, 3)
    assert row["total_pct"] == pytest.approx(100 * 8 / (8 * 10 + 4 * 20))


def test_a_set_of_models_states_its_first_start(monkeypatch, capsys):
    asked = []

    def rows_of(domain, scenarios, seeds, arguments):
        asked.append(seeds.first)
        made = {"scenario": "x", "horizon": 2, "n": 2, "improvement_pct": 1.0, "ci95": (0.5, 1.5), "slower_pct": 0.0}
        return [made | dict.fromkeys(COSTS, 0.0)], {}

    monkeypatch.setattr(refinement, "rows_of", rows_of)
    monkeypatch.setattr(refinement, "replica", lambda *_: argparse.Namespace(zoo="other"))
    monkeypatch.setattr(refinement, "seeds_of", lambda _, given: Seeds(9 if given.zoo else 1, {}))
    parser = argparse.ArgumentParser()
    refinement.configure(parser)
    given = parser.parse_args(["--domain", "soccer", "--scenario", "approach", "--models", "1", "--json"])
    assert refinement.run(given) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["first_seed"] for row in rows] == asked == [1, 9]


@pytest.mark.parametrize("scenario", ["approach-dribble", "opponents"])
def test_energy_is_known_whatever_else_the_ground_truth_tells_of(scenario):
    task = Task("soccer", scenario)
    cost = energy.cost_of(task, 0.0, 700_000)
    assert cost.energy_j == run_one(task, Variant("x"), 700_000).costs.energy_j > 0.1


def test_a_set_of_models_has_a_seed_of_training_of_its_own(monkeypatch, tmp_path):
    monkeypatch.setattr(replicas, "show", lambda *_: None)
    recipes = [replicas.replica(replicas.Recipe("soccer", (), 60, 0), k, tmp_path, 1).recipe for k in (1, 2)]
    assert len({recipe.seed for recipe in recipes}) == len({recipe.training.seed for recipe in recipes}) == 2


def test_a_set_of_models_is_made_by_the_recipe_of_those_that_ship_unless_numbers_are_given(monkeypatch, tmp_path):
    monkeypatch.setattr(replicas, "show", lambda *_: None)
    shipped = read_recipe(recipe_path("agilo"))
    own = replicas.replica(replicas.Recipe("soccer"), 1, tmp_path, 1).recipe
    assert (own.episodes, own.random, own.rounds) == (shipped.episodes, shipped.random, shipped.rounds)
    assert (own.calibration, own.uncertain, own.seed != shipped.seed) == (shipped.calibration, shipped.uncertain, True)
    other = replicas.replica(replicas.Recipe("soccer", ("waypoints",), 60, 5), 1, tmp_path, 1).recipe
    assert (other.episodes, other.random, other.uncertain, other.calibration) == (60, (), (), ())
    assert [(each.scenarios, each.episodes) for each in other.rounds] == [(("waypoints",), 5)]
