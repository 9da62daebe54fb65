"""A bus that was started anew has new passwords: a robot's processes end with a line that says so, others go on."""

from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from tailor.runtime.bus.opening import open_local_router
from tailor.runtime.bus.rights.credentials import Password
from tailor.runtime.bus.session import CannotOpenError, opened
from tailor.runtime.bus.zenoh_config import client
from tailor.runtime.processes.child import Child, tailor
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.messages import ArmRequest, EStop, VelocityCommand
from tailor.tools.launch.hosting import free_endpoint
from tailor.tools.main import TRY_AGAIN
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.xdist_group("systems")

BEGINNINGS = {
    ("sim", "agilo"): "disarmed: just started",
    ("executive", "soccer", "--wait"): "DISARMED: driver silent",
    ("driver", "robot.toml"): "agilo: not ready",
}
PLAIN_ROBOT = 'robot = "agilo"\n[bus]\nconnect = "tcp/127.0.0.1:1"\n[topics]\npose = ""\n[pose]\nstart = [0, 0, 0]\n'
GOLDEN = Path(__file__).resolve().parents[1] / "data" / "golden" / "soccer-approach-dribble.mcap"
SCENE_INPUTS = ("exec/provenance", "agilo/odom", "exec/status")  # the robot, where it is, and what it believes
ANEW = "the bus was started anew, with other passwords; start this command again as well"


@pytest.fixture
def system(tmp_path, monkeypatch):
    """Yields (endpoint, bus, start, lines): `bus` holds the router's session, `lines()` is what the child wrote."""
    endpoint, log, children = free_endpoint(), tmp_path / "log", []
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.toml").write_text(PLAIN_ROBOT)

    def start(command, notify_folder=None):
        with log.open("w") as output:
            children.append(Child("child", tailor(*command, "--connect", endpoint), output, notify_folder))
        return children[-1]

    with ExitStack() as bus:
        yield endpoint, bus, start, lambda: log.read_text().splitlines()
        for child in children:
            child.kill()


@pytest.mark.parametrize("command", BEGINNINGS)
def test_a_process_of_the_robot_ends_when_another_run_of_its_bus_begins(system, command):
    endpoint, bus, start, lines = system
    bus.enter_context(open_local_router(endpoint))
    child = start(command)
    wait_until(lambda: any(line.startswith(BEGINNINGS[command]) for line in lines()), "beginning")
    bus.close()
    assert child.wait(2.0) is None, "it waits for a bus that comes back, as an open one does"
    bus.enter_context(open_local_router(endpoint))
    assert child.wait(PATIENCE_S) == 2
    assert lines()[-1] == f"tailor {command[0]}: bus endpoint {endpoint}: {ANEW}"


def test_a_driving_robot_has_stopped_by_then(system):
    endpoint, bus, start, lines = system
    session, _ = bus.enter_context(open_local_router(endpoint))
    states, arming = session.inbox(["driver"], "agilo"), session.publisher("arm_request", "agilo")
    commands = session.publisher("cmd_vel", "agilo")
    child = start(("sim", "agilo"))
    wait_until(lambda: states.drain(0), "driver state")
    arming.publish(ArmRequest(arm=True, reset=False, sender=session.sender, epoch=0))

    def driving():
        commands.publish(VelocityCommand(0, 0.3, 0.0))
        return lines()[-1] == f"armed: obeys {session.sender[:8]}"

    wait_until(driving, "commands that are obeyed")
    bus.close()
    wait_until(lambda: lines()[-1].startswith("stopped: no valid command in time"), "the guard's stop")
    bus.enter_context(open_local_router(endpoint))
    assert child.wait(PATIENCE_S) == 2
    assert lines()[-2].startswith("disarmed: the driver ends")


def test_a_supervisor_is_asked_to_start_it_again(system, tmp_path):
    endpoint, bus, start, lines = system
    session, _ = bus.enter_context(open_local_router(endpoint))
    states = session.inbox(["driver"], "agilo")
    child = start(("sim", "agilo"), tmp_path)
    wait_until(lambda: states.drain(0), "driver state")
    bus.close()
    bus.enter_context(open_local_router(endpoint))
    assert child.wait(PATIENCE_S) == TRY_AGAIN
    assert lines() == [f"tailor sim: bus endpoint {endpoint}: {ANEW}"]


def test_scenes_of_the_next_run_are_published(system):
    endpoint, bus, start, _ = system
    recorded = {each.key: each for each in open_recording(GOLDEN).messages() if each.key in SCENE_INPUTS}

    def scene_of(session):
        players = {key: session.player(key, recorded[key].ros_type) for key in SCENE_INPUTS}
        scenes = session.inbox(["scene"], "agilo")

        def played():
            for key in SCENE_INPUTS:
                players[key].publish_encoded(recorded[key].data)
            return scenes.drain(0)

        return played

    session, _ = bus.enter_context(open_local_router(endpoint))
    start(("scene", "--live"))
    wait_until(scene_of(session), "scene")
    bus.close()
    session, _ = bus.enter_context(open_local_router(endpoint))
    wait_until(scene_of(session), "scene of the next run")


def test_an_estop_from_outside_reaches_the_next_run(system):
    """A gateway that people had started stayed cut off: `no driver is on the bus`, for good."""
    endpoint, bus, start, _ = system
    outside = free_endpoint()

    def let_in(folder):
        with suppress(CannotOpenError):
            return sessions.enter_context(opened(client([outside], 500, Password("people", folder.password("people")))))

    for run in (1, 2):
        session, folder = bus.enter_context(open_local_router(endpoint))
        stops = session.inbox(["estop"], "")
        if run == 1:
            start(("gateway", "--listen", outside))
        with ExitStack() as sessions:
            people = wait_until(lambda folder=folder: let_in(folder), "session")
            button = people.publisher("estop", "")
            wait_until(lambda button=button, stops=stops: button.publish(EStop(True)) and stops.drain(), "e-stop")
        bus.close()
