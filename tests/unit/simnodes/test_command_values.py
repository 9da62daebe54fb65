"""A driver reads the set-points of any command message in the order of its axes."""

from dataclasses import dataclass

from tailor.schemas.messages import EStop, JointCommand, Message, VelocityCommand
from tailor.simnodes.driver import command_values


@dataclass(frozen=True, slots=True)
class Lift(Message):
    stamp_ns: int
    up: float
    turn: float
    label: str


def test_messages_of_ours_are_read() -> None:
    assert command_values(VelocityCommand(1, 0.5, -0.2), ("v", "omega")) == (0.5, -0.2)
    assert command_values(JointCommand(1, ("b", "a"), (2.0, 1.0)), ("a", "b")) == (1.0, 2.0)


def test_a_message_of_a_package_has_a_field_for_each_axis() -> None:
    assert command_values(Lift(1, 0.5, -0.2, ""), ("turn", "up")) == (-0.2, 0.5)


def test_a_message_without_such_fields_is_refused() -> None:
    assert command_values(Lift(1, 0.5, -0.2, ""), ("turn", "grip")) == ()
    assert command_values(Lift(1, 0.5, -0.2, "3"), ("turn", "label")) != (-0.2, "3")
    assert command_values(EStop(True), ("v", "omega")) == ()
