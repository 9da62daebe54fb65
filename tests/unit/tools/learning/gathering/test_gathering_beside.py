"""Gathering beside one object, and training: success beside it is a model of its own, the action's others ignore it."""

from __future__ import annotations

import errno
import os
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.models.episodes.context_columns import beside_context, without_context
from tailor.models.episodes.episodes import merge, read_data_set
from tailor.models.export import zoo_writer
from tailor.models.inference import OnnxSuccess
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.training_request import TrainingRequest
from tailor.tools.learning.training_run import train_action
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.samplers.soccer import SoccerSampler

pytestmark = pytest.mark.usefixtures("few_first_ticks")

COUNT, COUNT_ALONE = 60, 24
RADIUS_M = 0.2
COLUMNS = (
    ContextColumn("obstacle_x", "m", -3.5, 3.5, 0.1),
    ContextColumn("obstacle_y", "m", -2.25, 2.25, 0.1),
    ContextColumn("obstacle_r", "m", 0.05, 0.3),
)


@dataclass(frozen=True, slots=True)
class AmongOpponents(SoccerSampler):
    """Puts an opponent of radius RADIUS_M on the way or near it, clear of its ends."""

    def context(self, action, arguments, rng):
        start, goal = arguments[:2], arguments[4:6]
        middle = start + rng.uniform(0.3, 0.7) * (goal - start)
        return np.array([*(middle + rng.uniform(-0.8, 0.8, 2)), RADIUS_M])

    def context_start(self, action, row, rng):
        return {"opponent1_x": row[0], "opponent1_y": row[1], "opponent1_radius": row[2]}


@pytest.fixture(scope="module")
def beside(few_draws, tmp_path_factory: pytest.TempPathFactory):
    """A data set of goToPose beside one opponent, and one of the same action by itself."""
    patch = pytest.MonkeyPatch()
    domain = domains.load("soccer")
    context = ActionContext(COLUMNS, lambda belief: np.zeros((0, 3)), "goToPose/clearance", "touched opponent")
    go = replace(domain.actions["goToPose"], context=context)
    among = replace(domain, actions={**domain.actions, "goToPose": go})
    patch.setattr(domains, "load", lambda name: among)
    patch.setattr(action_run, "sampler_of", lambda domain: AmongOpponents())
    root = tmp_path_factory.mktemp("beside")
    specs = [
        DataSetSpec("soccer", "goToPose", count, seed, root / name / "goToPose", beside=name == "beside")
        for name, count, seed in (("beside", COUNT, 7), ("alone", COUNT_ALONE, 8))
    ]
    for spec in specs:
        random_episodes.prepare(spec, resume=False)
        list(random_episodes.gather(spec, random_episodes.missing_parts(spec), jobs=1))
    yield tuple(spec.folder for spec in specs)
    patch.undo()


def test_what_is_driven_beside_an_object_is_told_apart(beside) -> None:
    """AGILO looks where it drives there, which takes 1.2 s of 6.5: intervals of both together held 85 and 84 %."""
    for folder, expected in zip(beside, (True, False), strict=True):
        assert {episode.in_context for episode in without_context(read_data_set(folder)).episodes} == {expected}


def test_object_is_recorded_in_further_columns(beside) -> None:
    data = read_data_set(beside[0])
    assert data.names[8:] == ("obstacle_x", "obstacle_y", "obstacle_r")
    for episode in data.episodes:
        assert (episode.ticks[:, 8:] == episode.arguments[8:]).all()
        assert episode.arguments[10] == RADIUS_M
    touched = sum(episode.failure == "touched opponent" for episode in data.episodes)
    assert 5 < touched < COUNT - 5


def test_action_by_itself_is_learned_from_episodes_that_no_object_spoiled(beside) -> None:
    data = read_data_set(beside[0])
    alone = without_context(data)
    assert alone.names == data.names[:8]
    assert len(alone.episodes) == sum(episode.failure != "touched opponent" for episode in data.episodes)
    assert merge([alone, read_data_set(beside[1])]).names == alone.names
    assert beside_context(read_data_set(beside[1])) is None


def test_other_failures_do_not_count_against_the_object(beside) -> None:
    data = read_data_set(beside[0])
    strayed = replace(data.episodes[0], success=False, failure="time limit")
    judged = beside_context(replace(data, episodes=(strayed, *data.episodes[1:])))
    assert judged is not None
    assert all(episode.failure in ("", "touched opponent") for episode in judged.episodes)


def test_a_full_disk_is_reported_with_the_model_and_leaves_no_file(beside, tmp_path: Path, monkeypatch) -> None:
    def full(path, card):
        path.touch()
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))  # as a write says it: of no file

    monkeypatch.setattr(zoo_writer, "write_card", full)
    folder = tmp_path / "agilo" / "goToPose"
    with pytest.raises(UsageError, match=re.escape(f"{folder / 'duration.onnx'} or its card: No space left on device")):
        list(train_action(list(beside), TrainingRequest("agilo", tmp_path, seed=1, learner="m5")))
    assert list(tmp_path.rglob("*duration*")) == []


def test_training_publishes_a_clearance_model_that_sees_the_object(beside, tmp_path: Path) -> None:
    request = TrainingRequest("agilo", tmp_path, seed=1, learner="m5")  # the default blends networks: 40 s
    former = tmp_path / "agilo" / "goToPose" / "duration_beside.onnx"
    former.parent.mkdir(parents=True)
    former.write_bytes(b"of other episodes")
    rows = {row["kind"]: row for row in train_action(list(beside), request)}
    assert set(rows) == {"duration", "energy", "clearance"}
    assert not former.exists(), "its mean would be that of the former durations"
    model = load_model(tmp_path / "agilo" / "goToPose" / "clearance.onnx")
    assert isinstance(model, OnnxSuccess)
    assert "--beside-object" in model.card["command"]
    way = np.array([[-2.0, 0, 0, 0, 2.0, 0, 0, 0]])
    on_way, far = (np.hstack([way, [[0.0, y, RADIUS_M]]]) for y in (0.0, 2.0))
    blocked, clear = model.probability(on_way)[0], model.probability(far)[0]
    assert (blocked < 0.6, clear > 0.7) == (True, True), "networks say no more from so few episodes"
    assert load_model(tmp_path / "agilo" / "goToPose" / "duration.onnx").predict(way)[0].shape == (1,)


def test_action_without_a_context_is_refused() -> None:
    with pytest.raises(UsageError, match="'dribbleBall' of soccer has no context"):
        random_episodes.check_action("soccer", "dribbleBall", beside=True)


def test_episodes_of_a_clearance_model_are_known_again_and_the_action_s_are_not_confused(beside) -> None:
    data = read_data_set(beside[0])
    judged = beside_context(data)
    assert judged is not None
    assert merge([judged]).manifest["probe"]["beside"]
    assert merge([without_context(data)]).manifest["probe"] is None
    assert "beside" not in merge([read_data_set(beside[1]), without_context(data)]).manifest["probe"]
