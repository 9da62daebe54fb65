"""Every child of a launcher is missed when it is silent, although it still exists: SIGSTOP at a random phase."""

import random
import time

import pytest

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.messages import DriverState
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.launch.recording_watch import ENDED
from tests.faults.supervision.launched import launched
from tests.support.patience import wait_until

LIMITS_S = {"executive": 1.0, "sim": 2.0, "record": 10.0}
POLL_S = 0.5  # of the launcher: 50 ms, and what a busy machine adds


def tries(slow):
    """One try among the fast tests, the others among the slow ones."""
    numbers = [0, *(pytest.param(number, marks=pytest.mark.slow) for number in range(1, slow))]
    return pytest.mark.parametrize("number", numbers)


@pytest.mark.promise("P2")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("name", ["executive", pytest.param("sim", marks=pytest.mark.slow)])
@tries(20)
def test_a_frozen_child_is_killed_and_started_again_and_the_robot_waits_for_people(name, number, tmp_path, measured):
    with launched(tmp_path) as system:
        wait_until(system.moves, "robot moves")
        time.sleep(random.Random(number).uniform(0.0, 0.3))
        measured.add(system.freeze(name), LIMITS_S[name] + POLL_S, what=name)
        started_again = lambda: (system.process(name).starts, system.process(name).state) == (2, "running")  # noqa: E731
        wait_until(started_again, "next start")
        system.latest.clear()
        wait_until(lambda: {DriverState, SoccerGroundTruth} <= system.poll().keys(), "driver")
        assert system.latest[DriverState].mode != "armed"
        wait_until(lambda: abs(system.poll()[SoccerGroundTruth].v) < 0.01, "robot at rest")
    assert f"{name} gave no sign of life; killed" in system.log.read_text()


@pytest.mark.promise("P51")
@pytest.mark.xdist_group("live")
@tries(20)
def test_a_frozen_recorder_is_killed_and_the_loss_reported_once_while_the_robot_goes_on(number, tmp_path, measured):
    with launched(tmp_path) as system:
        wait_until(system.moves, "robot moves")
        time.sleep(random.Random(number).uniform(0.0, 0.3))
        measured.add(system.freeze("record"), LIMITS_S["record"] + POLL_S)
        wait_until(lambda: system.process("record").state == "ended", "state")
        system.latest.clear()
        wait_until(system.moves, "robot moves still")
        assert system.up.exit_code() is None
    assert system.log.read_text().count(ENDED) == 1
    assert sum(1 for _ in open_recording(system.recording).messages()) > 100
