"""The arm writes: real core, models, controller, physics, driver and guard, in lock-step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.domains.arm.action_library import ACTIONS
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.runtime import load_robot
from tailor.tools.lockstep.samplers.arm import ArmSampler
from tailor.tools.writing.measures import waypoint_errors_rad
from tailor.tools.writing.writing_mode import WritingMode
from tailor.tools.writing.writing_run import RecordedBody, write

MODELS = Models(*load_robot("powercube"))
BODY = RecordedBody()
REFINED = WritingMode("refined", RefinementSettings())
GREEDY = WritingMode("greedy", replace(RefinementSettings(), horizon=1))
STOPPING = WritingMode("stopping", RefinementSettings(), stops=True)


def written(text, hand, seed=3):
    return write(text, hand, MODELS, seed, BODY)[0]


@pytest.mark.parametrize("hand", [STOPPING, GREEDY, REFINED], ids=lambda hand: hand.name)
@pytest.mark.parametrize("letter", "TFS")
def test_a_letter_passes_every_waypoint_within_ten_milliradians(letter, hand):
    track = written(letter, hand)
    assert track.result == "achieved"
    assert len(track.arrivals_s) == len(track.waypoints)
    assert waypoint_errors_rad(track).max() < 0.010


def test_a_refined_hand_is_faster_than_one_that_stops():
    assert all(written(letter, REFINED).duration_s < written(letter, STOPPING).duration_s for letter in "TFSA")


def test_a_hand_that_stops_rests_at_its_waypoints_and_a_refined_one_does_not():
    def fastest_passage(track):
        speeds = np.linalg.norm(track.velocities, axis=1)
        return max(np.interp(track.arrivals_s, track.times_s, speeds))

    assert fastest_passage(written("Z", STOPPING)) < 0.05
    assert fastest_passage(written("Z", REFINED)) > 0.2


def test_the_same_seed_writes_the_same_bits():
    first, again = written("P", REFINED), written("P", REFINED)
    assert first.angles.tobytes() == again.angles.tobytes()
    assert first.duration_s == again.duration_s


def test_a_word_is_written_letter_by_letter():
    track = written("IT", REFINED)
    assert track.result == "achieved"
    assert len(track.waypoints) == 8
    down = track.pen_down().astype(int)
    assert np.count_nonzero(np.diff(down) == 1) == 2, "the pen goes down once a letter"
    assert waypoint_errors_rad(track).max() < 0.010


def test_arrival_errors_are_those_of_the_two_writing_joints():
    body = RecordedBody()
    body.reset(np.random.default_rng(0), {"a": 0.3, "b": -0.2})
    arguments = np.array([0.0, 0.0, 0.0, 0.0, 0.3, 0.0, 0.1, 0.4])
    errors = ArmSampler().arrival_errors(ACTIONS["reach"], arguments, body.ground_truth())
    assert errors == {"position_rad": pytest.approx(0.3, abs=0.01), "speed_radps": pytest.approx(0.4, abs=0.01)}
