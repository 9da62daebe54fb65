"""tailor evaluate on-policy: rows of the actions that the executive chose, with intervals over its runs."""

import json
from pathlib import Path

import numpy as np
import pytest

from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.models.trees.model_tree import ModelTreeRegressor
from tailor.tools.evaluations.models import fresh, on_policy
from tailor.tools.main import main
from tests.support import standin

NAMES = ("x", "y", "phi", "v", "xg", "yg", "phig", "vg")


def write_set(folder: Path, action: str, runs: int, per_run: int, seed: int, finished: bool = True) -> None:
    """Drives of so many runs; without any an empty data set, as of an action that nothing chose."""
    drives = enumerate(standin.episodes(runs * per_run, seed))
    episodes = [
        Episode(100 * (k // per_run) + k % per_run, ticks[0], ticks, s, True, "", finished)
        for k, (ticks, s, _) in drives
    ]
    (folder / action).mkdir(parents=True)
    arguments = [{"name": name, "unit": "", "lower": -4, "upper": 4} for name in NAMES]
    about = {"robot": "agilo", "action": action, "arguments": arguments, "seed": seed, "on_policy": per_run > 1}
    write_manifest(folder / action, about)
    write_part(folder / action / "part-000000.parquet", episodes, NAMES)


@pytest.fixture
def evaluated(tmp_path, monkeypatch, capsys):
    """Rows, remarks and errors of an evaluation whose runs chose drives and no approach."""
    monkeypatch.setattr(on_policy, "fit", lambda kind, name, rows, space, seed: ModelTreeRegressor("linear").fit(
        space(rows.arguments), rows.targets, groups=rows.groups))  # fmt: skip
    monkeypatch.setattr(on_policy, "modelled_actions", lambda domain: ["approachBall", "goToPose"])

    def found(runs: int, random: int = 60) -> tuple[int, dict, str]:
        data, folders = tmp_path / "data", [tmp_path / "first", tmp_path / "second"]
        for seed, action in enumerate(("approachBall", "goToPose")):
            write_set(data, action, random, 1, seed)
        for seed, folder in enumerate(folders, 2):
            write_set(folder, "approachBall", 0, 4, seed)
            write_set(folder, "goToPose", runs, 4, seed)
        monkeypatch.setattr(fresh, "chosen", lambda *arguments: folders[arguments[3] % 2])
        code = main(["evaluate", "on-policy", "--data", str(data), "--seed", "0", "--json"])
        out, err = capsys.readouterr()
        return code, json.loads(out) if out else {}, err

    return found


def test_an_action_that_nothing_chose_has_no_rows_and_ends_nothing(evaluated):
    code, report, _ = evaluated(12)
    assert code == 0
    assert [row["action"] for row in report["rows"]] == ["goToPose"] * 2
    assert report["remarks"][0].startswith("approachBall: never chosen")


@pytest.mark.parametrize(("runs", "known"), [(9, False), (12, True)])
def test_the_interval_of_choices_is_over_runs_of_which_few_have_none(evaluated, runs, known):
    _, report, _ = evaluated(runs)
    for row in report["rows"]:
        assert np.isfinite(np.array(row["policy_ci95"], float)).all() == known
        assert np.isfinite(row["random_ci95"]).all()


def test_runs_without_any_choice_are_a_usage_error(evaluated):
    code, _, err = evaluated(0)
    (line,) = [each for each in err.splitlines() if each.startswith("tailor")]
    assert code == 2
    assert line.endswith("approach-dribble, waypoints: no action finished in both rounds, expected more --episodes")


def test_too_few_random_episodes_are_refused_before_any_run(evaluated, monkeypatch):
    code, _, err = evaluated(3, random=30)
    assert code == 2
    assert err.endswith("data/approachBall: 30 finished episodes, expected at least 40\n")


def test_runs_that_judge_have_no_seed_that_models_are_trained_with() -> None:
    assert min(map(fresh.run_seed, (0, 1, 999_999, 1_000_000, 2**28))) >= 1_000_000
