"""Training beside objects: which models there are, and that training and test never share a run."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.training import success_training
from tailor.tools.learning.training_request import TrainingRequest, reproduction_command, spaces_by_kind
from tailor.tools.learning.training_run import context_jobs, own_jobs

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


@pytest.mark.parametrize(
    ("entries", "flags"),
    [
        ({}, "goToPose --episodes 5 --seed 3"),
        ({"profile": "degraded"}, "goToPose --episodes 5 --seed 3 --profile degraded"),
        ({"objects": 4}, "goToPose --beside-objects 4 --episodes 5 --seed 3"),
        ({"context": {"names": ["r"]}}, "goToPose --beside-object --episodes 5 --seed 3"),
        ({"scenarios": ["a", "b"], "on_policy": True}, "--on-policy a b --episodes 5 --seed 3"),
        ({"scenarios": ["a"], "situations": 20}, "--active a --pool 4 --episodes 5 --seed 3"),
    ],
)
def test_a_card_names_the_command_that_gathered_its_episodes(entries, flags) -> None:
    request, folder = TrainingRequest("agilo", Path()), Path("data/agilo/goToPose")
    manifest = {"action": "goToPose", "episodes": 5, "seed": 3, **entries}
    command = reproduction_command(request, spaces_by_kind(request, NAMES[:8], folder), {folder: manifest})
    assert command.startswith(f"tailor gather agilo {flags} --out data/agilo && tailor train agilo goToPose ")
