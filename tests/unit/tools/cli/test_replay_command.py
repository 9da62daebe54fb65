"""`tailor replay` on a secured bus: what it may not publish there is refused or named, never dropped without a word.

And how it ends where the router has frozen.
"""

from contextlib import contextmanager

import pytest

from tailor.runtime.bus.session import Session
from tailor.runtime.stopping import Stop
from tailor.schemas.messages import ArmRequest, Odometry
from tailor.tools.commands.look import replay
from tailor.tools.main import main
from tests.support.bus_system import bus_system
from tests.unit.tools.test_comparison import Script


@pytest.fixture
def recording(tmp_path):
    script = Script(tmp_path / "r.mcap")
    script.say(0, "agilo/arm_request", ArmRequest(True, False, "", 0))
    for tick in range(3):
        script.say(tick, "agilo/odom", Odometry(0, tick / 10, 0.0, 0.0, 0.0, 0.0))
        script.say(tick, "lidar/odom", Odometry(0, tick / 10, 0.0, 0.0, 0.0, 0.0))
    return script.close()


@pytest.fixture(autouse=True)
def secured(monkeypatch):
    monkeypatch.setattr(replay, "_is_secured", lambda arguments: True)


def replayed(recording, *options):
    with bus_system() as (_, endpoint, _):
        return main(["replay", recording, "--connect", endpoint, "--wait", "0", "--rate", "100", *options])


def test_one_that_is_to_drive_is_refused(recording, capsys):
    """It left out all that drives, and ended with 0."""
    assert main(["replay", recording, "--drive", "--connect", "tcp/127.0.0.1:9"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert error.startswith("tailor replay: --drive: the bus is secured")


def test_topics_that_the_bus_takes_from_no_replay_are_named_and_left_out(recording, capsys):
    assert replayed(recording, "--topics", "odom", "--remap", "lidar/odom=hall/lidar/odom") == 0
    output, errors = capsys.readouterr()
    assert "on a secured bus nobody replays hall/lidar/odom; omitted\n" in errors
    assert output.startswith("3 messages")


def test_one_of_which_nothing_would_arrive_is_refused(recording, capsys):
    remap = ("--topics", "lidar/odom", "--remap", "lidar/odom=agilo/cmd_vel2")
    assert replayed(recording, *remap) == 2
    assert "nobody replays agilo/cmd_vel2, expected other topics, or an open bus" in capsys.readouterr().err


@pytest.mark.parametrize(("lost_first", "code"), [(False, 0), (True, 1)])
def test_one_that_people_stop_has_not_been_ended_by_a_router_that_has_frozen(
    recording, capsys, monkeypatch, lost_first, code
):
    """Its session is missed 1 s later, and takes ten more to close, in which nothing was printed."""
    stop, read = Stop(), []

    def connected(session):
        stop.requested = not lost_first
        return False

    @contextmanager
    def closing(*arguments):
        with opened(*arguments) as session:
            yield session
            read.append(capsys.readouterr())

    opened = replay.open_bus
    monkeypatch.setattr(replay, "open_bus", closing)
    monkeypatch.setattr(replay, "stop_on_signals", lambda: stop)
    monkeypatch.setattr(Session, "connected", property(connected))
    assert replayed(recording, "--topics", "odom") == code
    [(output, errors)] = read
    assert output.startswith("0 messages")
    assert ("bus disconnected" in errors) == lost_first
