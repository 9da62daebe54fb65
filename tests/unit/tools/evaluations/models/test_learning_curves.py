"""Learning curves of the gain: equal numbers of episodes, fresh models of each set, one row a point."""

import json
from types import SimpleNamespace

import pytest

from tailor.tools.evaluations import dependencies
from tailor.tools.evaluations.models import learning_curves
from tailor.tools.evaluations.models.learning_curves import FIRST_RECIPE_SEED, METHODS, Point
from tailor.tools.learning.recipe import Calibration, RandomEpisodes, Recipe, Training, UncertainEpisodes
from tailor.tools.main import main


@pytest.mark.parametrize("method", METHODS)
def test_every_way_of_gathering_has_as_many_episodes_of_each_action(method: str) -> None:
    calibration = (Calibration(("approach",), 50),)
    further = {"random": (RandomEpisodes("approachBall", 9),), "uncertain": (UncertainEpisodes("approachBall", 9),)}
    shipped = Recipe(7, beside=1000, calibration=calibration, training=Training(learner="linear"), **further)
    recipe = Point(method, 301).recipe(shipped, "approach", 9)
    assert recipe.episodes + sum(each.episodes for each in recipe.rounds) == 301
    assert (recipe.random, recipe.uncertain) == ((), ())
    assert [each.source for each in recipe.rounds] == ([] if method == "random" else [method])
    assert (recipe.seed, recipe.calibration, recipe.training.learner) == (9, (), "linear")
    assert 0 < recipe.beside < 100  # or the executive refuses to start among objects


def test_a_row_is_the_mean_over_sets_of_models_with_seeds_of_their_own(monkeypatch, capsys, tmp_path) -> None:
    made, starts = [], []
    monkeypatch.setattr(learning_curves, "make", lambda making: made.append(making) or [])

    def run_all(task, variants, seeds, *_):
        starts.append(tuple(seeds))
        gain = 0.1 * made[-1].recipe.seed - 0.1 * FIRST_RECIPE_SEED
        runs = {v.name: {s: SimpleNamespace(achieved=True, duration_s=10.0) for s in seeds} for v in variants}
        runs["h2"] = {s: SimpleNamespace(achieved=True, duration_s=10.0 * (1 - gain) + 0.1 * (s % 3)) for s in seeds}
        return runs

    monkeypatch.setattr(learning_curves, "run_all", run_all)
    monkeypatch.setattr(learning_curves, "_errors", lambda *_: {"error_pct": 2.0})
    flags = ["--domain", "soccer", "--episodes", "100", "--sets", "2", "--starts", "3", "--methods", "random", "active"]
    flags += ["--store", str(tmp_path)]
    assert main(["evaluate", "learning-curves", *flags, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [(row["gathered"], row["episodes"], row["sets"], row["n"]) for row in rows] == [
        ("random", 100, 2, 6), ("active", 100, 2, 6)
    ]  # fmt: skip
    assert rows[0]["improvement_pct"] == pytest.approx(14.0)
    assert rows[0]["ci95"][0] < 14.0 < rows[0]["ci95"][1]
    assert len(set(starts)) == 1  # all sets are judged from the same starts
    assert len({making.zoo for making in made}) == 4
    flags[flags.index("--sets") + 1] = "3"
    assert main(["evaluate", "learning-curves", *flags, "--json"]) == 0
    assert [making.recipe.seed for making in made[4:]] == [FIRST_RECIPE_SEED + 3] * 2  # the other sets are known
    assert [row["n"] for row in json.loads(capsys.readouterr().out)["rows"]] == [9, 9]


def test_figures_of_other_measuring_source_are_measured_anew(monkeypatch, capsys, tmp_path) -> None:
    """A gain that is computed otherwise would else be averaged with those of before."""
    monkeypatch.setattr(learning_curves, "make", lambda making: [])
    measured = []
    monkeypatch.setattr(learning_curves, "_measured", lambda *_: measured.append(1) or {"failed_pct": 0.0})
    flags = ["--domain", "soccer", "--episodes", "100", "--sets", "2", "--starts", "2", "--methods", "random"]
    counts = []
    for changed in ("", "", "paired_comparison.py", "model_rows.py", "costs.py"):
        monkeypatch.setattr(dependencies, "content_sha256", lambda path: str(path.name == changed))  # noqa: B023
        assert main(["evaluate", "learning-curves", *flags, "--store", str(tmp_path), "--json"]) == 0
        counts.append(len(measured))
    capsys.readouterr()
    assert counts == [2, 2, 4, 6, 8]


def test_a_set_whose_models_hardly_ever_reach_the_goal_has_no_gain_and_ends_no_curve(monkeypatch, capsys, tmp_path):
    made = []
    monkeypatch.setattr(learning_curves, "make", lambda making: made.append(making) or [])

    def run_all(task, variants, seeds, *_):
        poor = made[-1].recipe.seed == FIRST_RECIPE_SEED + 1 or made[-1].recipe.episodes < 200
        return {
            v.name: {s: SimpleNamespace(achieved=not poor or s == seeds[0], duration_s=10.0 - k) for s in seeds}
            for k, v in enumerate(variants)
        }

    monkeypatch.setattr(learning_curves, "run_all", run_all)
    monkeypatch.setattr(learning_curves, "_errors", lambda *_: {"error_pct": 2.0})
    flags = ["--domain", "soccer", "--episodes", "100", "300", "--sets", "3", "--starts", "4", "--methods", "random"]
    flags += ["--store", str(tmp_path / "store"), "--report", str(tmp_path), "--json"]
    assert main(["evaluate", "learning-curves", *flags]) == 0
    few, many = json.loads(capsys.readouterr().out)["rows"]
    assert (few["sets"], few["without_gain"], few["improvement_pct"], few["failed_pct"]) == (3, 3, None, 75.0)
    assert (many["sets"], many["without_gain"], many["improvement_pct"]) == (3, 1, pytest.approx(10.0))
    assert (many["failed_pct"], many["mean_greedy_s"]) == (25.0, 10.0)


def test_a_start_at_which_the_goal_holds_is_no_failure_and_has_no_duration(monkeypatch, tmp_path) -> None:
    def run_all(task, variants, seeds, *_):
        return {
            v.name: {s: SimpleNamespace(achieved=True, duration_s=10.0 - k if s else float("nan")) for s in seeds}
            for k, v in enumerate(variants)
        }

    monkeypatch.setattr(learning_curves, "run_all", run_all)
    monkeypatch.setattr(learning_curves, "_errors", lambda *_: {})
    settings = SimpleNamespace(domain="soccer", scenario="aligned", seed=0, starts=4, jobs=1, store=tmp_path)
    found = learning_curves._measured(SimpleNamespace(zoo=tmp_path), "", settings)
    assert (found["improvement_pct"], found["failed_pct"]) == (pytest.approx(10.0), 0.0)


def test_a_domain_must_be_named(capsys) -> None:
    assert main(["evaluate", "learning-curves"]) == 2
    assert "expected --domain NAME" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--scenario", "chess"], "--scenario chess: no such scenario, expected one of approach-dribble, aligned"),
        (["--zoo", "out/zoo"], "--zoo is out/zoo, expected none: learning-curves trains every model that it judges"),
    ],
)
def test_what_would_be_found_wrong_after_hours_is_refused_at_once(monkeypatch, capsys, flags, message) -> None:
    monkeypatch.setattr(learning_curves, "make", lambda making: pytest.fail("it began"))
    assert main(["evaluate", "learning-curves", "--domain", "soccer", *flags]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line


def test_a_point_that_is_named_twice_counts_its_sets_once(monkeypatch, capsys) -> None:
    """Intervals are over sets of models; a set that counts twice would make them too narrow."""
    monkeypatch.setattr(
        learning_curves, "_figures", lambda point, number, _: {"improvement_pct": float(number), "error_pct": 2.0}
    )
    flags = ["--domain", "soccer", "--episodes", "100", "100", "--methods", "random", "random", "--sets", "2", "--json"]
    assert main(["evaluate", "learning-curves", *flags]) == 0
    assert [row["sets"] for row in json.loads(capsys.readouterr().out)["rows"]] == [2]
