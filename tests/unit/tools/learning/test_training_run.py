"""Training beside objects: which models there are, and that training and test never share a run."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.models.cards.card import read_card
from tailor.models.episodes.episodes import DataSet, Episode, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.models.training import success_training
from tailor.schemas.errors import UsageError
from tailor.tools.learning.training_request import TrainingRequest, reproduction_command, spaces_by_kind
from tailor.tools.learning.training_run import context_jobs, own_jobs, train_action
from tests.support import standin

NAMES = ("x", "y", "phi", "v", "xg", "yg", "phig", "vg", "obstacle_x", "obstacle_y", "obstacle_r")


def beside(runs: int, objects: int, missing: int = 0, noted: bool = True) -> DataSet:
    """A data set of runs with so many episodes each; the first argument names set and run."""
    episodes = [
        Episode(k, row := np.full(len(NAMES), 1000.0 * objects + k // objects), row[None, :], 1.0, True, "")
        for k in range(missing, runs * objects)
    ]
    manifest = {
        "robot": "agilo",
        "action": "goToPose",
        "arguments": [{"name": name} for name in NAMES],
        "context": {"names": list(NAMES[8:]), "failure": "touched opponent"},
        **({"objects": objects} if noted else {}),
    }
    return DataSet(manifest, tuple(episodes), f"{runs} {objects}")


@pytest.mark.parametrize(
    "sets",
    [
        (beside(5, 2), beside(4, 3)),
        (beside(4, 3), beside(5, 2)),
        (beside(6, 4), beside(7, 1, noted=False)),
        (beside(5, 3, missing=2), beside(2, 4)),
    ],
)
def test_episodes_of_one_run_have_a_number_of_their_own_however_many_objects_each_set_has(sets, monkeypatch) -> None:
    learned = []
    monkeypatch.setattr(success_training, "train_success", lambda episodes, *_: learned.extend(episodes))
    ((merged, kind, learner, train, space),) = context_jobs(sets, TrainingRequest("agilo", Path()), Path())
    train(merged.episodes, space, learner, 1)
    assert kind == "clearance"
    runs = {(e.arguments[0], e.number) for e in learned}
    assert len(learned) == sum(len(each.episodes) for each in sets)
    assert len(runs) == len({run for run, _ in runs}) == len({number for _, number in runs})
    assert {number for _, number in runs} == set(range(len(runs)))


@pytest.mark.parametrize(
    ("in_context", "alone", "apart"),
    [(100, 100, True), (99, 100, False), (100, 99, False), (150, 0, False)],
)
def test_intervals_are_apart_only_where_both_sorts_of_episodes_determine_them(in_context, alone, apart) -> None:
    data = beside(in_context + alone, 1, noted=False)
    marked = tuple(replace(episode, in_context=episode.number < in_context) for episode in data.episodes)
    kinds = [kind for kind, *_ in own_jobs(replace(data, episodes=marked), TrainingRequest("agilo", Path("zoo")))]
    assert ("duration_beside" in kinds) == apart
    assert "duration" in kinds


def written(folder: Path, seed: int, late_s: float = 0.0, **entries: object) -> Path:
    """A data set of planar drives, of which every sixth failed."""
    made = enumerate(standin.episodes(150, seed))
    episodes = [Episode(k, t[0], t, d + late_s, k % 6 > 0, "" if k % 6 else "late") for k, (t, d, _) in made]
    folder.mkdir(parents=True)
    write_part(folder / "part-000000.parquet", episodes, NAMES[:8])
    arguments = [{"name": name, "unit": "", "lower": -4, "upper": 4} for name in NAMES[:8]]
    about = {"robot": "agilo", "action": "goToPose", "arguments": arguments, "seed": seed, **entries}
    write_manifest(folder, about)
    return folder


def test_no_duration_is_learned_from_episodes_that_calibrate_and_cards_count_them(tmp_path) -> None:
    own, calibrating = written(tmp_path / "a", 1), written(tmp_path / "b", 2, 3.0, on_policy=True, calibrates=True)
    request = TrainingRequest("agilo", tmp_path, learner="linear", failure_learner="tree", seed=3)
    tests = {}
    for zoo, folders in (("alone", [own]), ("both", [own, calibrating])):
        rows = train_action(folders, replace(request, zoo=tmp_path / zoo))
        tests[zoo] = {row["kind"]: row for row in rows}
    errors = [tests[zoo]["duration"]["mae_s"] for zoo in tests]
    assert errors[0] == errors[1]
    assert tests["both"]["duration"]["intervals"] != tests["alone"]["duration"]["intervals"]
    assert tests["both"]["success"]["n"] == pytest.approx(2 * tests["alone"]["success"]["n"], abs=1)
    card = read_card(tmp_path / "both" / "agilo" / "goToPose" / "duration.card.json")["episodes"]
    assert (card["count"], card["calibrates"], [s.get("calibrates") for s in card["sources"]]) == (
        300,
        150,
        [None, True],
    )
    with pytest.raises(UsageError, match="b: 0 finished episodes, expected at least 40"):
        list(train_action([calibrating], request))


@pytest.mark.parametrize(
    ("entries", "flags"),
    [
        ({}, "goToPose --episodes 5 --seed 3"),
        ({"profile": "degraded"}, "goToPose --episodes 5 --seed 3 --profile degraded"),
        ({"objects": 4}, "goToPose --beside-objects 4 --episodes 5 --seed 3"),
        ({"context": {"names": ["r"]}}, "goToPose --beside-object --episodes 5 --seed 3"),
        ({"scenarios": ["a", "b"], "on_policy": True}, "--on-policy a b --episodes 5 --seed 3"),
        (
            {"scenarios": ["a"], "on_policy": True, "calibrates": True},
            "--on-policy a --calibrates --episodes 5 --seed 3",
        ),
        ({"scenarios": ["a"], "situations": 20}, "--active a --pool 4 --episodes 5 --seed 3"),
    ],
)
def test_a_card_names_the_command_that_gathered_its_episodes(entries, flags) -> None:
    request, folder = TrainingRequest("agilo", Path()), Path("data/agilo/goToPose")
    manifest = {"action": "goToPose", "episodes": 5, "seed": 3, **entries}
    command = reproduction_command(request, spaces_by_kind(request, NAMES[:8], folder), {folder: manifest})
    assert command.startswith(f"tailor gather agilo {flags} --out data/agilo && tailor train agilo goToPose ")
