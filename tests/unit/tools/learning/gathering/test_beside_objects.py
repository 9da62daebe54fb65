"""Opponents noted after a run: those that the simulated robot would have touched, and no others."""

import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.messages.soccer import OpponentsTruth
from tailor.simnodes.agilo.scene import RAIL
from tailor.tools.learning.gathering import beside_objects, random_episodes
from tailor.tools.learning.gathering.beside_objects import runs_beside_objects
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.lockstep import action_run
from tailor.tools.lockstep.action_run import new_body, run_action
from tailor.tools.lockstep.samplers import opponents
from tailor.tools.lockstep.task_sampler import TaskSampler, sampler_of
from tailor.tools.main import main

DOMAIN = domains.load("soccer")
ACTION = DOMAIN.actions["goToPose"]
GRAZED_M = 0.02  # nearer to a touch than this, both may be right


def driven_beside(body, run, start, opponent):
    """Whether the robot touches a simulated opponent with the commands of a run, from its start."""
    x, y, radius = opponent
    body.reset(np.random.default_rng(0), {**start, "opponent1_x": x, "opponent1_y": y, "opponent1_radius": radius})
    for tick in run.trace[:-1]:
        body.command(tick.command)
        readings = body.advance(10**8)
        if any(reading.message.touched for reading in readings if isinstance(reading.message, OpponentsTruth)):
            return True
    return False


@pytest.mark.parametrize("number", range(4))
def test_a_noted_touch_is_a_touch_in_simulation(number):
    sampler, body = sampler_of(DOMAIN), new_body(DOMAIN)
    arguments = sampler.sample_among_objects(ACTION, np.random.default_rng([5, number]))
    run = run_action(body, DOMAIN, "goToPose", arguments, np.random.default_rng([6, number]), traced=True)
    start = sampler.start(ACTION, arguments, np.random.default_rng(0))
    poses = opponents.poses_of([tick.truth for tick in run.trace])
    for k in range(6):
        opponent = opponents.draw_beside(poses, np.random.default_rng([7, number, k]))
        clear_m = opponents.clearances(poses, np.array([opponent[:2]])).min() - opponent[2]
        if abs(clear_m) > GRAZED_M:
            assert driven_beside(body, run, start, opponent) is bool(clear_m < 0), (opponent, clear_m)


def test_the_outline_is_the_simulated_one():
    model = new_body(DOMAIN)._model
    ends = [model.geom(name).pos[:2] for name in RAIL]
    middles = (opponents.RAIL[1:] + opponents.RAIL[:-1]) / 2
    assert all(np.hypot(*(middles - end).T).min() < 2e-3 for end in ends)
    at = np.zeros((1, 3))
    places = np.array([[-0.5, 0.0], [0.0, 0.4], [0.6, 0.0], [0.318, 0.0]])
    clear = opponents.clearances(at, places)[:, 0]
    assert clear == pytest.approx([0.27, 0.24, math.hypot(0.6 - 0.288, 0.119) - 0.005, 0.118], abs=4e-3)


def test_a_sampler_that_draws_no_objects_is_refused_before_anything_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr(beside_objects, "sampler_of", lambda domain: object())
    spec = DataSetSpec("soccer", "goToPose", 1, 1, tmp_path / "goToPose", beside=True, objects=2)
    with pytest.raises(UsageError, match="the sampler object of soccer lacks `sample_among_objects` or `beside`"):
        random_episodes.prepare(spec, resume=False)
    assert not (tmp_path / "goToPose").exists()


class PlacesNone(TaskSampler):
    """As a robot's package has it that declares a context, and no more than the defaults of a sampler."""


class Bare:
    """Not even derived from `TaskSampler`."""

    def context(self, action, arguments, rng):
        return np.zeros(3)


@pytest.mark.parametrize(
    ("sampler", "lacks"),
    [
        (PlacesNone, "PlacesNone of soccer lacks `context` and `context_start`"),
        (Bare, "lacks `context_start`, expected"),
    ],
)
def test_a_sampler_that_puts_no_object_there_is_refused_in_one_line(tmp_path, monkeypatch, capsys, sampler, lacks):
    for module in (beside_objects, action_run):
        monkeypatch.setattr(module, "sampler_of", lambda domain: sampler())
    assert main(["gather", "agilo", "--beside-object", "--out", str(tmp_path / "data")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert lacks in line
    assert not (tmp_path / "data").exists()


def test_one_run_gives_many_episodes_with_one_object_each():
    def rng_of(number):
        return np.random.default_rng([3, number])

    episodes, simulated_s = runs_beside_objects(12, DOMAIN, "goToPose", new_body(DOMAIN), range(2, 4), rng_of)
    again, _ = runs_beside_objects(12, DOMAIN, "goToPose", new_body(DOMAIN), range(3, 4), rng_of)
    assert [episode.number for episode in episodes] == list(range(24, 48))
    assert all(np.array_equal(a.arguments, b.arguments) for a, b in zip(episodes[12:], again, strict=True))
    assert simulated_s > 1.0
    assert {episode.arguments.shape for episode in episodes} == {(11,)}
    assert {episode.failure for episode in episodes} == {"", ACTION.context.failure}
    assert all(episode.success is (episode.failure == "") for episode in episodes)
