"""Driver, world and simulator services without a bus."""

import json

import numpy as np
import pytest

from tailor.schemas.messages import ArmRequest, EStop, JointCommand, Sample, VelocityCommand
from tailor.simnodes.driver import Driver, command_values
from tailor.simnodes.driver_spec import DriverSpec, shipped_driver_spec
from tailor.simnodes.guard import Limit, Mode, Reason
from tailor.simnodes.services import Services
from tailor.simnodes.world import Event, World
from tests.support.stand_ins.body import FakeBody

A, B = "a" * 32, "b" * 32
MS = 1_000_000
DECLARED = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


def arm(by=A, at_ns=0, **changes):
    request = {"arm": True, "reset": False, "sender": "", "epoch": 0, **changes}
    return Sample("agilo/arm_request", ArmRequest(**request), at_ns, 1, by)


def command(v, sequence, sender=A, at_ns=0):
    return Sample("agilo/cmd_vel", VelocityCommand(0, v, 0.0), at_ns, sequence, sender)


def test_an_arming_request_without_a_name_arms_whoever_sent_it():
    driver = Driver(DECLARED, 7)
    driver.take([arm(A), command(0.5, 1, A, 1)], {}, 1)
    assert driver.guard.output(1) == (0.5, 0.0)


def test_a_person_may_arm_the_executive():
    driver = Driver(DECLARED, 7)
    driver.take([arm(B, sender=A), command(0.5, 1, A, 1)], {}, 1)
    assert driver.guard.sender == A


def test_an_estop_beats_everything_that_arrives_with_it():
    driver = Driver(DECLARED, 7)
    driver.take([arm(A)], {}, 0)
    driver.take([command(0.5, 1), arm(A, 1), Sample("estop", EStop(True), 2, 1, B)], {}, 2)
    assert driver.guard.mode is Mode.ESTOPPED
    assert driver.guard.output(2) == (0.0, 0.0)
    driver.take([Sample("estop", EStop(False), 3, 2, B)], {}, 3)
    assert driver.guard.mode is Mode.ESTOPPED, "false does not release"


def test_disarming_names_who_did_it_and_heeds_the_epoch():
    driver = Driver(DECLARED, 7)
    driver.take([arm(A)], {}, 0)
    driver.take([arm(B, arm=False, epoch=6)], {}, 0)
    assert driver.guard.mode is Mode.ARMED
    driver.take([arm(B, arm=False, epoch=7)], {}, 0)
    assert (driver.guard.mode, driver.guard.reason) == (Mode.DISARMED, Reason.DISARM_REQUEST)
    assert driver.guard.detail == "by bbbbbbbb"


def test_the_state_is_told_at_10_hz_and_on_change():
    driver = Driver(DECLARED, 7)
    assert driver.state(0, 5).mode == "disarmed"
    assert driver.state(99 * MS, 5) is None
    assert driver.state(100 * MS, 5) is not None
    driver.take([arm(A, at_ns=110 * MS)], {}, 110 * MS)
    told = driver.state(110 * MS, 5)
    assert (told.mode, told.epoch, told.armed_sender) == ("armed", 7, A)


def test_the_state_counts_refusals_and_undecodable_bytes():
    driver = Driver(DECLARED, 7)
    driver.take([command(0.5, 1)], {"malformed": 3}, 0)
    told = driver.state(0, 5)
    assert dict(zip(told.refused_reasons, told.refused_counts, strict=True)) == {"not armed": 1, "malformed": 3}


def test_a_message_that_is_no_command_never_moves_anything():
    driver = Driver(DECLARED, 7)
    driver.take([arm(A)], {}, 0)
    driver.take([Sample("agilo/cmd_vel", EStop(False), 0, 1, A), Sample("x", None, 0, 2, A)], {}, 0)
    assert driver.guard.output(0) == (0.0, 0.0)


def test_joint_commands_go_by_name():
    command = JointCommand(0, ("elbow", "wrist"), (0.1, 0.2))
    assert command_values(command, ("wrist", "elbow")) == (0.2, 0.1)
    assert command_values(command, ("wrist", "elbow", "base")) == ()
    assert command_values(command, ("wrist", "base")) == ()
    assert command_values(JointCommand(0, ("elbow", "wrist"), (0.1,)), ("wrist", "elbow")) == (0.1,)


def test_agilo_declares_its_limits_and_the_time_out():
    assert shipped_driver_spec("agilo") == DriverSpec("cmd_vel", ("v", "omega"), (Limit(-0.9, 0.9), Limit(-1.75, 1.75)))


def make_world(*events):
    return World(FakeBody(), {"x": 2.0}, 3, events)


def test_events_count_from_the_first_obeyed_command():
    world = make_world(Event(0.05, {"ball_x": 9.0}))
    world.advance(500 * MS)
    world.begin()
    world.advance(50 * MS)
    assert world.body.state["ball_x"] == 1.0
    world.begin()
    world.advance(10 * MS)
    assert world.body.state["ball_x"] == 9.0


def test_a_reset_brings_back_start_noise_and_events():
    world = make_world(Event(0.0, {"ball_x": 9.0}))
    first = world.body.noise
    world.begin()
    world.advance(50 * MS)
    world.reset()
    assert (world.body.noise, world.time_ns, world.body.state["x"], world.body.state["ball_x"]) == (first, 0, 2.0, 1.0)
    world.advance(50 * MS)
    assert world.body.state["ball_x"] == 1.0
    world.reset(seed=4, start={"x": 1.0})
    assert world.body.noise == np.random.default_rng([4, 1]).normal()
    assert world.body.state["x"] == 1.0


def test_a_world_steps_in_whole_body_steps():
    with pytest.raises(ValueError, match="multiple"):
        make_world().advance(1)


class RequestSource:
    def __init__(self, text):
        self.text, self.answer = text, None

    def accept(self, said):
        self.answer = (True, said)

    def refuse(self, why):
        self.answer = (False, why)


class Queue:
    def __init__(self, *asked):
        self.waiting = list(asked)

    def poll(self):
        return self.waiting.pop(0) if self.waiting else None


def ask(name, text, paused=False):
    resets = []
    asked = RequestSource(text)
    services = Services(make_world(), {name: Queue(asked)}, on_reset=lambda: resets.append(1))
    services.paused = paused
    services.answer()
    return services, asked.answer, resets


def test_services_do_what_they_are_asked():
    services, answer, resets = ask("reset", json.dumps({"seed": 9, "start": {"x": 5}}))
    assert (answer, resets, services._world.body.state["x"]) == ((True, "reset"), [1], 5.0)
    assert ask("reset", "")[1] == (True, "reset")
    services, answer, _ = ask("place", '{"ball_x": 4}')
    assert (answer, services._world.body.state["ball_x"]) == ((True, "placed"), 4.0)
    assert ask("pause", "true")[0].paused
    services, answer, _ = ask("step", "25", paused=True)
    assert (answer, services.steps_due) == ((True, "25 periods"), 25)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("reset", "[]"),
        ("reset", '{"sed": 1}'),
        ("reset", '{"seed": -1}'),
        ("reset", '{"seed": true}'),
        ("reset", '{"start": {"x": NaN}}'),
        ("place", "3"),
        ("place", '{"x": "1"}'),
        ("place", '{"x": Infinity}'),
        ("pause", "1"),
        ("step", "0"),
        ("step", "1000000"),
        ("step", "1.5"),
        ("step", "not json"),
        ("place", "[" * 100_000),
    ],
)
def test_services_refuse_what_makes_no_sense(name, text):
    services, answer, resets = ask(name, text, paused=True)
    assert answer[0] is False
    assert (resets, services.steps_due) == ([], 0)


def test_stepping_needs_a_pause():
    assert ask("step", "1")[1] == (False, "step: pause first")
