"""Who may speak on a secured bus: each intrusion is tried without credentials, and with those of every other role.

The robot is driven meanwhile; nothing but its own executive's speed may come out of the guard.
"""

import subprocess
import time
from contextlib import ExitStack

import pytest

from tailor.runtime.bus import zenoh_config
from tailor.runtime.bus.attachment import Origin
from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.rights.credentials import Password
from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.session import CannotOpenError, opened
from tailor.runtime.processes.child import tailor
from tailor.schemas.codec import encode
from tailor.schemas.messages import ArmRequest, EStop, VelocityCommand
from tailor.schemas.own import example
from tailor.schemas.services import ROLES
from tailor.schemas.topics import TOPICS, key_of
from tests.support.bus_system import guarded_robot, moving, outputs, secured_system
from tests.support.driven import Driven
from tests.support.patience import wait_until

pytestmark = pytest.mark.xdist_group("systems")
SPEED = 0.5
OTHER_SPEED = 0.9
STEP_S = 0.3  # more than the driver's periods; less than the executive's silence that stops a robot


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    """A robot that moves on a secured bus, shared by all tests: none of them may change anything."""
    with guarded_robot(tmp_path_factory.mktemp("robot"), secured_system) as (session, endpoint, start, trace):
        yield Driven(session, endpoint, start, trace)


@pytest.fixture
def intruder(robot):
    """Opens a session with the password of a role, at the gateway like another user's process, or locally."""
    with ExitStack() as stack:

        def enter(role, locally=False):
            if locally:
                return stack.enter_context(open_client(robot.endpoint, role=role))
            password = Password(role, run_folder(robot.endpoint).password(role))
            return stack.enter_context(opened(zenoh_config.client([robot.endpoint], 3000, password)))

        yield enter


def unmoved(robot, since_s):
    """Whether the guard's output stayed the executive's speed."""
    time.sleep(STEP_S)
    assert moving(robot.trace, SPEED)()
    return not [v for at, v in outputs(robot.trace) if at > since_s and v != SPEED]


WRONG = {
    "none": None,
    "a guessed password": Password("people", "0" * 32),
    "an unknown name": Password("root", "0" * 32),
    "an empty password": Password("executive", ""),
    "the password of certificates": zenoh_config.BY_CERTIFICATE,
}


@pytest.mark.promise("P16")
@pytest.mark.parametrize("credentials", WRONG)
def test_without_credentials_of_this_run_no_session_opens(robot, credentials):
    config = zenoh_config.client([robot.endpoint], 700, WRONG[credentials])
    with pytest.raises(CannotOpenError), opened(config):
        pass


@pytest.mark.promise("P16")
def test_the_passwords_are_for_their_user_alone(robot):
    folder = run_folder(robot.endpoint)
    assert folder.path.stat().st_mode & 0o077 == 0
    assert folder.users_file.stat().st_mode & 0o077 == 0


@pytest.mark.promise("P16")
def test_the_password_of_an_earlier_run_opens_nothing(robot):
    with secured_system() as (_, endpoint, _):
        password = Password("people", run_folder(endpoint).password("people"))
    with pytest.raises(CannotOpenError), opened(zenoh_config.client([robot.endpoint], 700, password)):
        pass


def raw_put(session, key, payload):
    """A publication that our own session class would refuse."""
    session._zenoh.put(key, payload)


def raw_delete(session, key):
    session._zenoh.delete(key)


SENSORS = {
    "odom", "pose", "ball", "ball2", "opponents", "joint_states", "currents", "driver",
    "truth", "ball2_truth", "opponents_truth", "joint_truth", "planar_truth", "gripper", "objects", "kitchen_truth",
}  # fmt: skip
REPORTS = {
    "status", "finished", "plan", "plan_request", "plan_answer", "contexts", "subgoals", "refinement", "tick",
    "provenance",
}  # fmt: skip
SCENES = {"scene", "scene_truth", "transforms", "log"}
MAY_PUBLISH = {
    "executive": {"cmd_vel", "joint_cmd", "gripper_cmd", "self_arm", *REPORTS},
    "driver": SENSORS,
    "people": {"arm_request", "estop"},
    "recorder": set(),
    "observer": set(),
    "scene": SCENES,
    "player": {*SENSORS, *REPORTS, *SCENES, "clock"} - {"driver"},  # by its state a driver confirms an e-stop
}


@pytest.mark.promise("P16")
@pytest.mark.parametrize("locally", [False, True], ids=["at the gateway", "locally"])
@pytest.mark.parametrize("role", ROLES)
def test_a_role_publishes_what_is_its_own_and_nothing_else(robot, intruder, role, locally):
    listener, session = intruder("observer"), intruder(role, locally)
    inbox = listener.inbox([name for name in TOPICS if name != "estop"], "ghost", newest_only=False)
    stops, subscription = listener.subscribe_all("estop")
    publishers = {name: session.publisher(name, "ghost") for name in TOPICS}
    time.sleep(STEP_S)
    for name, publisher in publishers.items():
        if name != "estop":
            publisher.publish(example(TOPICS[name].type))
    if role != "people":  # theirs would stop the robot: tests/faults/test_estop_live.py
        publishers["estop"].publish(EStop(True))
    time.sleep(STEP_S)
    heard = {sample.key for sample in inbox.drain() if sample.sender == session.sender}
    subscription.undeclare()
    assert heard == {key_of(name, "ghost") for name in MAY_PUBLISH[role] - {"estop"}}
    assert stops.drain() == []
    assert unmoved(robot, time.monotonic() - 2 * STEP_S)


def newest_command(session):
    """Sender and number of the executive's newest command, as everybody on the bus can read them."""
    inbox = session.inbox(["cmd_vel"], "agilo")
    sample = wait_until(inbox.drain, "a command")[-1]
    return sample.sender, sample.sequence


@pytest.mark.promise("P16")
@pytest.mark.parametrize("role", [role for role in ROLES if role != "executive"])
def test_a_copied_sender_and_the_next_number_move_nothing_in_another_role(robot, intruder, role):
    session = intruder(role)
    publisher = session.publisher("cmd_vel", "agilo")
    sender, number = newest_command(session)
    since_s = time.monotonic()
    for ahead in range(1, 21):
        command = VelocityCommand(time.time_ns(), OTHER_SPEED, 0.0)
        publisher.put_raw(encode(command), Origin(number + ahead, time.time_ns(), sender))
        time.sleep(0.01)
    assert unmoved(robot, since_s)


@pytest.mark.promise("P16")
@pytest.mark.parametrize("role", [role for role in ROLES if role != "people"])
def test_nobody_but_people_arm_disarm_and_stop(robot, intruder, role):
    session = intruder(role)
    arming, stops, since_s = session.publisher("arm_request", "agilo"), session.publisher("estop", ""), time.monotonic()
    for request in (ArmRequest(False, False, "", 0), ArmRequest(True, True, session.sender, 0)):
        arming.publish(request)
        stops.publish(EStop(True))
        time.sleep(0.05)
    assert unmoved(robot, since_s)


@pytest.mark.promise("P16")
@pytest.mark.parametrize("role", ROLES)
def test_a_pattern_a_deletion_and_an_oversize_message_reach_nobody(robot, intruder, role):
    listener, session = intruder("observer"), intruder(role)
    queue, subscription = listener.subscribe_all("**")
    key = {"executive": "agilo/cmd_vel", "people": "agilo/arm_request"}.get(role, "agilo/odom")
    since_s = time.monotonic()
    for put in (
        lambda: raw_put(session, "**", b"x"),
        lambda: raw_put(session, "agilo/*", b"x"),
        lambda: raw_put(session, "*/cmd_vel", encode(VelocityCommand(0, OTHER_SPEED, 0.0))),
        lambda: raw_put(session, "estop/**", b"x"),
        lambda: raw_put(session, "other/key", b"x"),
        lambda: raw_put(session, key, b"x" * 4097),
        lambda: raw_delete(session, key),
    ):
        put()
    time.sleep(STEP_S)
    subscription.undeclare()
    assert [(raw.key, len(raw.payload)) for raw in queue.drain() if len(raw.payload) in (0, 1, 4097)] == []
    assert unmoved(robot, since_s)


@pytest.mark.promise("P16")
@pytest.mark.parametrize("role", [role for role in ROLES if role != "executive"])
def test_a_strangers_server_answers_no_goal(robot, intruder, role):
    server = intruder(role).service_server("exec/goal")
    time.sleep(STEP_S)
    command = tailor("goal", "--connect", robot.endpoint)
    goal = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while goal.poll() is None:
        request = server.poll()
        if request is not None:
            request.accept("accepted")
        time.sleep(0.01)
    assert goal.returncode == 2
    assert "no service at exec/goal" in goal.communicate()[1]


@pytest.mark.promise("P16")
@pytest.mark.parametrize("role", [role for role in ROLES if role not in ("people", "executive")])
def test_only_people_send_goals_and_reset_simulators(robot, intruder, role):
    session = intruder(role)
    for key in ("exec/goal", "agilo/sim/reset", "recorder/snapshot"):
        accepted, answer = session.call(key, "", 0.5)
        assert not accepted, answer
    assert unmoved(robot, time.monotonic() - STEP_S)
