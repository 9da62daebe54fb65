"""tailor evaluate models: rows of random arguments, and of the executive's own choices."""

import argparse
import json
from dataclasses import replace

import numpy as np
import pytest

from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.training import learners
from tailor.models.trees.model_tree import ModelTreeRegressor
from tailor.tools.evaluations.assertion import assertion
from tailor.tools.evaluations.models import floors, fresh, model_rows, table2
from tailor.tools.evaluations.models.model_rows import duration_columns
from tailor.tools.figures.learned_models import reports
from tailor.tools.learning.gathering import choosing_models, policy_runs
from tailor.tools.main import main


def test_models_are_judged_on_random_arguments_and_on_the_executives_choices(tmp_path, capsys, monkeypatch):
    panels = []
    monkeypatch.setattr(reports, "scatter", lambda path, predicted, observed: panels.extend(predicted) or path)
    words = ["evaluate", "models", "--domain", "arm", "--episodes", "6", "--on-policy", "letter-I", "--runs", "2"]
    (tmp_path / "models.png").write_bytes(b"")
    assert main([*words, "--jobs", "1", "--json", "--store", str(tmp_path), "--report", str(tmp_path)]) == 0
    random, chosen = json.loads(capsys.readouterr().out)["rows"]
    assert panels == ["reach", "reach, letter-I"]
    assert (random["chosen_in"], random["episodes"]) == ("", 6)
    assert (chosen["chosen_in"], chosen["action"]) == ("letter-I", "reach")
    assert chosen["episodes"] >= 2
    assert len(chosen["coverage_thirds_pct"]) == 3
    assert "noise_floor_s" in random


@pytest.mark.parametrize("name", ["table1", "table2"])
def test_the_papers_tables_are_of_random_arguments_alone(name, capsys):
    assert main(["evaluate", name, "--on-policy", "waypoints"]) == 2
    assert "--on-policy" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("missed", "false_alarms", "failures", "reaches"),
    [
        (0.3, 0.8, 0.7, True),
        (0.7, 0.0, 0.7, False),
        (0.5, 0.9, 0.7, False),
        (0.0, 0.0, 0.0, True),
        (1.1, 1.0, 9.0, False),
    ],
)
def test_a_model_that_foresees_no_failure_does_not_reach_table_2(missed, false_alarms, failures, reaches):
    row = {"failure_accuracy_pct": 100 - missed - false_alarms, "missed_failures_pct": missed}
    assert table2.reached({**row, "false_alarms_pct": false_alarms, "failures_pct": failures}) is reaches


def test_an_unknown_scenario_is_a_usage_error(capsys):
    assert main(["evaluate", "models", "--domain", "arm", "--on-policy", "chess"]) == 2
    assert "--on-policy chess: no such scenario of arm, expected some of letter-A" in capsys.readouterr().err


def test_runs_of_another_executive_are_gathered_anew_and_do_not_end_the_evaluation(tmp_path, monkeypatch):
    """With a seed of one's own, the folder of before would be of other choices: gathering refuses to mix them."""
    monkeypatch.setattr(policy_runs, "_run_missing", lambda policy, jobs: iter(()))
    folders = []
    for executive in ("a" * 64, "b" * 64, "a" * 64):
        for module in (fresh, choosing_models):
            monkeypatch.setattr(module, "runs_sha256", lambda domain, found=executive: found, raising=False)
        folders.append(fresh.chosen("powercube", ("letter-I",), 2, 5, "", 1, tmp_path))
    assert folders[0] == folders[2] != folders[1]


class Wide:
    """Predicts 3 s, and an interval of some width."""

    card = {"episodes": {"finished": 9}}

    def __init__(self, half_s):
        self.half_s = half_s

    def predict(self, arguments):
        return np.full(len(arguments), 3.0), np.full(len(arguments), self.half_s)

    def interval(self, arguments):
        mean, std = self.predict(arguments)
        return mean, mean - std, mean + std


def test_each_episode_is_judged_by_the_interval_that_the_executive_had():
    ticks = np.zeros((3, 8))
    episodes = [Episode(k, ticks[0], ticks, 4.0, True, "", in_context=k < 2) for k in range(3)]
    data = DataSet({"arguments": []}, tuple(episodes), "")
    models = {"go/duration": Wide(0.5), "go/duration_beside": Wide(1.5)}
    row = duration_columns(models, "go/duration", data, 1)
    assert row["coverage_pct"] == pytest.approx(200 / 3)
    assert row["interval_s"] == pytest.approx((3.0 + 3.0 + 1.0) / 3)
    assert duration_columns({"go/duration": Wide(0.5)}, "go/duration", data, 1)["coverage_pct"] == 0


def test_a_ratio_is_known_as_soon_as_some_task_has_noise(monkeypatch):
    """In a third of the resamples no task has any."""
    episodes = tuple(Episode(number, np.zeros(1), np.zeros((2, 1)), 0.1, True, "") for number in range(12))
    data = DataSet({"arguments": []}, episodes, "")
    row = {"predicted_s": np.full(12, 0.3), "observed_s": np.full(12, 0.1)}
    for floor_s, expected in (([0.0] * 11 + [0.3], 8.0), ([0.0] * 12, None)):
        monkeypatch.setattr(floors, "noise_floor", lambda *_, floor_s=floor_s: (np.array(floor_s), np.ones(12)))
        found = floors.floor_columns(row, data, ("r", "a", 1, 1))
        assert found.get("over_floor") == (expected and pytest.approx(expected))
        low, high = found.get("over_floor_ci95", (1.0, 1.0))
        assert 1.0 <= low <= high < np.inf


@pytest.mark.parametrize(("count", "known"), [(9, False), (10, True)])
def test_errors_of_a_few_runs_have_no_interval(monkeypatch, count, known):
    """One run of a rare action had one without width, and the bootstrap of a few holds too seldom what it promises."""
    seconds = 3.1 + 0.1 * np.arange(count)
    episodes = tuple(Episode(k, np.zeros(8), np.zeros((2, 8)), float(s), True, "") for k, s in enumerate(seconds))
    data = DataSet({"arguments": []}, episodes, "")
    row = duration_columns({"go/duration": Wide(0.5)}, "go/duration", data, 1)
    assert np.isfinite(row["mae_ci95"]).all() == known
    monkeypatch.setattr(floors, "noise_floor", lambda *_: (0.1 * seconds, np.ones(count)))
    over = floors.floor_columns(row, data, ("r", "a", 1, 1))
    assert over["over_floor"] > 0
    assert np.isfinite(over["over_floor_ci95"]).all() == known


class Sure:
    """Predicts that every action succeeds."""

    threshold = 0.5

    def probability(self, arguments):
        return np.ones(len(arguments))


def test_a_failure_model_is_shown_beside_one_that_predicts_nothing():
    episodes = tuple(Episode(k, np.zeros(1), np.zeros((2, 1)), 1.0, k > 0, "" if k else "late") for k in range(10))
    row = model_rows._failures(Sure(), DataSet({}, episodes, ""))
    assert (row["failure_accuracy_pct"], row["missed_failures_pct"]) == (90.0, 10.0)
    assert row["constant_accuracy_pct"] == 90.0


def test_runs_that_do_not_finish_have_no_share_in_the_noise_floor(monkeypatch):
    """A model is judged by the episodes that finished, and the time limit is no noise that it could not predict."""
    ends = iter([(4.0, True)] * 7 + [(40.0, False)])

    def run_action(*_):
        duration_s, done = next(ends)
        return argparse.Namespace(duration_s=duration_s, done=done, success=done)

    monkeypatch.setattr(floors.action_run, "run_action", run_action)
    floor_s, alike = floors.noise_floor("agilo", "goToPose", np.zeros((1, 8)), 1, 1)
    assert (floor_s.tolist(), alike.tolist()) == ([0.0], [7 / 8])


@pytest.mark.parametrize(
    ("words", "action", "never"),
    [
        (("models", "--domain", "arm", "--episodes", "6"), "reach", "evaluation"),
        (("feature-spaces",), "goToPose", "training"),
        (("feature-spaces",), "goToPose", "evaluation"),
        (("duration-learners",), "goToPose", "training"),
        (("duration-learners",), "goToPose", "evaluation"),
    ],
)
def test_an_action_that_never_finishes_is_named(monkeypatch, capsys, tmp_path, words, action, never):
    episode = Episode(0, np.zeros(10), np.zeros((2, 10)), 40.0, False, "time limit", finished=False)
    ended = replace(episode, finished=True)
    for stream in ("training", "evaluation"):
        data = DataSet({}, (episode if stream == never else ended,) * 6, "")
        monkeypatch.setattr(fresh, stream, lambda *_, data=data: data)
    assert main(["evaluate", *words, "--store", str(tmp_path)]) == 2
    assert f"{action}: none of 6 episodes finished, expected some to judge by" in capsys.readouterr().err


def test_episodes_of_one_run_count_as_one_unit_of_the_errors_interval():
    ticks, durations_s = np.zeros((1, 8)), (3.1, 3.3, 3.5, 3.9) * 3  # errors of twelve runs
    once = [Episode(100 * run, ticks[0], ticks, s, True, "") for run, s in enumerate(durations_s)]
    often = [replace(each, number=each.number + k) for each in once for k in range(25)]
    models = {"go/duration": Wide(0.5)}
    one, many = (
        duration_columns(models, "go/duration", DataSet({"arguments": []}, tuple(some), ""), 1, per_run=100)
        for some in (once, often)
    )
    assert many["mae_s"] == pytest.approx(one["mae_s"])
    assert many["mae_ci95"] == pytest.approx(one["mae_ci95"])
    alone = duration_columns(models, "go/duration", DataSet({"arguments": []}, tuple(often), ""), 1)["mae_ci95"]
    assert alone[1] - alone[0] < 0.5 * (many["mae_ci95"][1] - many["mae_ci95"][0])


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("duration-learners", "--actions", "goToPose", "fly"), "no action 'fly' in soccer"),
        (("on-policy", "--data", "none"), "none/approachBall: no manifest.json, expected a data set"),
        (("assertion", "--scenarios", "opponents", "chess"), "--scenarios chess: expected some of: opponents, "),
        (("feature-spaces", "--robot", "powercube", "--action", "reach"), "expected x y phi v xg yg phig vg by"),
    ],
)
def test_what_an_evaluation_lacks_is_found_before_it_runs(words, expected, monkeypatch, capsys, tmp_path):
    def run(*_, **__):
        raise AssertionError("hours of runs")

    for made in ("training", "evaluation", "chosen"):
        monkeypatch.setattr(fresh, made, run)
    monkeypatch.setattr(assertion, "run_all", run)
    assert main(["evaluate", *words, "--store", str(tmp_path)]) == 2
    assert expected in capsys.readouterr().err


def test_learners_of_an_arm_are_compared_on_features_of_joints(monkeypatch, capsys, tmp_path):
    """Those of poses take no joints: it ended in a traceback after all episodes."""
    rng = np.random.default_rng(3)
    ticks = [np.array([row]) for row in rng.uniform(-1, 1, (60, 10))]
    episodes = tuple(Episode(k, row[0], row, 1 + abs(row[0, 0] - row[0, 4]), True, "") for k, row in enumerate(ticks))
    for stream in ("training", "evaluation"):
        monkeypatch.setattr(fresh, stream, lambda *_: DataSet({}, episodes, ""))
    monkeypatch.setattr(learners, "DURATION_LEARNERS", {"linear": lambda _: ModelTreeRegressor("linear")})
    words = ["evaluate", "duration-learners", "--robot", "powercube", "--actions", "reach", "--store", str(tmp_path)]
    assert main([*words, "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["rows"]
    assert (row["action"], row["learner"]) == ("reach", "linear")
