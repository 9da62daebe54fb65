"""Joint messages survive their bytes, and an incomplete joint state is refused."""

from tailor.schemas import messages as m
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected

STATE = m.JointState(5, ("pan", "lift"), (1.0, -2.0), (0.0, 0.1), (3.0, 4.0))


def test_joint_messages_survive_their_bytes_exactly():
    command = m.JointCommand(1, ("pan", "lift"), (0.1, -0.2))
    currents = m.MotorCurrents(2, ("pan",), (0.5,), (2.0,))
    for message in (STATE, m.JointState(0), command, currents):
        assert decode(type(message), encode(message)) == message


def test_a_joint_state_without_velocities_is_refused():
    silent = m.JointState(5, ("pan", "lift"), (1.0, -2.0), (), (3.0, 4.0))
    assert decode(m.JointState, encode(silent)) == Rejected("a joint lacks a value")
