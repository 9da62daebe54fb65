"""Reports state which source, models and seeds they are of, and stored runs of other source do not count."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.training import learners
from tailor.tools.evaluations import dependencies
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.seeds import FIRST_SEED
from tailor.tools.main import main

TASK, PLAIN, HAND_MADE = Task("soccer", "approach"), Variant("h2"), Variant("baseline", hand_made=True)
KEYS = {"first_seed", "seed_derived", "source_sha256", "models_sha256"}


def drawn(robot: str, action: str, count: int, seed: int, jobs: int, store: object) -> DataSet:
    """Drives whose durations grow with their distances; every fourth fails."""
    rng = np.random.default_rng(count)
    arguments = rng.uniform(-1.0, 1.0, (60, 8))
    distance = np.hypot(*(arguments[:, 4:6] - arguments[:, :2]).T)
    episodes = [
        Episode(k, row, np.tile(row, (8, 1)), 1.0 + way, k % 4 > 0, "" if k % 4 else "late")
        for k, (row, way) in enumerate(zip(arguments, distance.tolist(), strict=True))
    ]
    return DataSet({}, tuple(episodes), "")


@pytest.fixture
def hashed_after(monkeypatch):
    """The dependencies of a run once the files of some names have changed."""

    def found(changed, *arguments):
        monkeypatch.setattr(dependencies, "content_sha256", lambda path: f"{path.name} {path.name in changed}")
        return dependencies.dependencies(TASK, *arguments)

    return found


@pytest.mark.parametrize(
    ("changed", "arguments"),
    [
        ("graph.py", (HAND_MADE,)),
        ("controller.py", (HAND_MADE,)),
        ("search.py", (PLAIN, dependencies.SEARCH)),
        ("shell.py", (PLAIN, dependencies.OVER_BUS)),
        ("loop.py", (PLAIN, dependencies.OVER_BUS)),
        ("system.py", (PLAIN, dependencies.OVER_BUS)),
    ],
)
def test_a_file_that_only_some_runs_depend_on_counts_for_these(changed, arguments, hashed_after):
    assert hashed_after([changed], *arguments) != hashed_after([], *arguments)
    assert hashed_after([changed], PLAIN) == hashed_after([], PLAIN)


@pytest.mark.parametrize("changed", ["costs.py", "outcome.py", "pinned.py", "task_runs.py"])
def test_what_makes_and_measures_every_run_counts_for_all(changed, hashed_after):
    assert hashed_after([changed], PLAIN) != hashed_after([], PLAIN)


@pytest.mark.parametrize("name", ["duration-learners", "failure-learners", "feature-spaces"])
@pytest.mark.parametrize("seed", [None, 5])
def test_a_report_of_learners_states_its_seeds_and_hashes(name, seed, tmp_path, monkeypatch, capsys) -> None:
    for table, kept in (("DURATION_LEARNERS", "linear"), ("SUCCESS_LEARNERS", "tree")):
        monkeypatch.setattr(learners, table, {kept: getattr(learners, table)[kept]})
    monkeypatch.setattr(fresh, "training", drawn)
    monkeypatch.setattr(fresh, "evaluation", drawn)
    main(["evaluate", name, "--json", "--report", str(tmp_path), *([] if seed is None else ["--seed", str(seed)])])
    printed = json.loads(capsys.readouterr().out)
    about = printed["provenance"]
    assert set(about) == KEYS
    assert about["seed_derived"] == (seed is None)
    assert about["first_seed"] == seed if seed is not None else about["first_seed"] >= FIRST_SEED
    assert f"seeds from {about['first_seed']}" in printed["remarks"][-1]
    assert json.loads((tmp_path / f"{name}.json").read_text())["provenance"] == about


def test_feature_spaces_learn_from_episodes_that_finished(tmp_path, monkeypatch, capsys) -> None:
    """The time limit is not the duration of an action."""

    def gathered(*arguments: object) -> DataSet:
        data = drawn("", "", 3, 1, 1, None)
        late = [replace(each, number=60 + each.number, duration_s=900.0, finished=False) for each in data.episodes[:20]]
        return replace(data, episodes=(*data.episodes, *late))

    monkeypatch.setattr(fresh, "training", gathered)
    monkeypatch.setattr(fresh, "evaluation", gathered)
    main(["evaluate", "feature-spaces", "--json", "--store", str(tmp_path)])
    assert all(row["mae_s"] < 1.0 for row in json.loads(capsys.readouterr().out)["rows"])


@pytest.mark.parametrize(("name", "kind"), [("duration-learners", "learner"), ("feature-spaces", "space")])
@pytest.mark.parametrize(("count", "known"), [(9, False), (40, True)])
def test_errors_on_a_few_fresh_episodes_have_no_interval(name, kind, count, known, monkeypatch, capsys) -> None:
    """The percentile bootstrap of four holds the truth in three of four cases, of two in half of them."""
    monkeypatch.setattr(learners, "DURATION_LEARNERS", {"linear": learners.DURATION_LEARNERS["linear"]})
    monkeypatch.setattr(fresh, "training", drawn)
    few = drawn("", "", 1, 1, 1, None)
    kept = tuple(episode for episode in few.episodes if episode.finished)[:count]
    monkeypatch.setattr(fresh, "evaluation", lambda *_: replace(few, episodes=kept))
    main(["evaluate", name, "--json"])
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert all(row[kind] and np.isfinite(np.array(row["mae_ci95"], float)).all() == known for row in rows)
