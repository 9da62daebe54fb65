"""Every message survives its bytes; no bytes whatever raise."""

import math
from dataclasses import is_dataclass, replace
from functools import cache
from typing import get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.schemas import messages as m
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages.scenes import FrameTransforms, LogLine, SceneShapes
from tailor.schemas.messages.soccer import BallPercept, OpponentPercept, OpponentPercepts
from tailor.schemas.numbers import MAX_FROM_ROBOT, MAX_NUMBER
from tailor.schemas.own import example
from tailor.schemas.packages.msg_definitions import field_types
from tailor.schemas.packages.pose3 import Pose3
from tailor.schemas.ros_time import MAX_STAMP_NS
from tailor.schemas.standard import pose_from_ros, pose_to_ros
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import message_types

MESSAGES = message_types()
OWN = [kind for kind in MESSAGES if not kind.ROS_TYPE]
PLAIN = {
    int: st.integers(-(2**63), 2**63 - 1),
    bool: st.booleans(),
    str: st.text(max_size=20).filter(lambda text: "\0" not in text),
}


def values(name, hint, most):
    if name == "stamp_ns":
        return st.integers(0, MAX_STAMP_NS)
    if name.startswith("var_"):
        return st.floats(0.0, MAX_NUMBER)
    plain = PLAIN | {float: st.floats(-most, most)}
    if hint in plain:
        return plain[hint]
    item = get_args(hint)[0]
    return st.lists(plain[item] if item in plain else messages(item, most), max_size=4).map(tuple)


@cache
def messages(kind, most=MAX_NUMBER):
    most = MAX_FROM_ROBOT if getattr(kind, "FRAME_ID", "") == "base_link" else most
    return st.builds(kind, **{name: values(name, hint, most) for name, hint in field_types(kind).items()})


any_own = st.sampled_from(OWN).flatmap(messages)
# Of ROS' own types with narrower numbers than ours; other readers check them in tests/contract/test_scene_readers.py.
NARROW = (LogLine, SceneShapes, FrameTransforms)
any_message = st.sampled_from([kind for kind in MESSAGES if kind not in NARROW]).flatmap(messages)


@given(any_own)
@settings(max_examples=300, deadline=None)
def test_own_messages_survive_their_bytes_exactly(message):
    assert decode(type(message), encode(message)) == message


@given(messages(m.VelocityCommand) | messages(m.EStop))
@settings(deadline=None)
def test_command_and_estop_survive_their_bytes_exactly(message):
    assert decode(type(message), encode(message)) == message


@given(messages(m.Odometry) | messages(m.PoseEstimate), st.floats(-math.pi, math.pi))
@settings(deadline=None)
def test_poses_survive_with_their_angle_within_rounding(message, phi):
    message = replace(message, phi=phi)
    decoded = decode(type(message), encode(message))
    assert isinstance(decoded, type(message))
    assert abs(math.remainder(decoded.phi - phi, math.tau)) < 1e-12
    assert replace(decoded, phi=phi) == message


@pytest.mark.promise("P18")
@given(st.sampled_from(MESSAGES), st.binary(max_size=400))
@settings(max_examples=300, deadline=None)
def test_random_bytes_never_raise(kind, noise):
    assert isinstance(decode(kind, noise), Rejected | kind)
    assert isinstance(decode(kind, b"\0\1\0\0" + noise), Rejected | kind)


@pytest.mark.promise("P18")
@given(any_message, st.data())
@settings(max_examples=200, deadline=None)
def test_truncated_bytes_are_rejected(message, data):
    whole = encode(message)
    cut = data.draw(st.integers(0, len(whole) - 1))
    assert decode(type(message), whole[:cut]) in (Rejected("malformed"), Rejected("trailing bytes"))


@pytest.mark.promise("P18")
@given(any_message, st.data())
@settings(max_examples=300, deadline=None)
def test_mutated_bytes_never_raise(message, data):
    whole = bytearray(encode(message))
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    assert isinstance(decode(type(message), bytes(whole)), Rejected | type(message))


@given(any_message, st.integers(0, 12))
@settings(deadline=None)
def test_up_to_seven_trailing_bytes_are_padding(message, count):
    decoded = decode(type(message), encode(message) + bytes(count))
    assert (decoded == Rejected("trailing bytes")) == (count > 7)


COLOURS = ("red", "green", "blue", "alpha")


def put_float(name, value):
    return lambda message, bad: replace(message, **{name: value(bad)})


def float_paths(kind):
    """Every float of a message type, with a function that puts a value there."""
    for name, hint in field_types(kind).items():
        item = get_args(hint)[0] if get_args(hint) else None
        if hint is float:
            yield name, put_float(name, lambda bad: bad)
        elif item is float:
            yield name, put_float(name, lambda bad: (0.0, 0.0, bad))  # a whole point, where they are points
        elif is_dataclass(item):
            for path, put in float_paths(item):
                yield f"{name}.{path}", put_float(name, lambda bad, i=item, p=put: (p(example(i), bad),))


FLOAT_FIELDS = [
    pytest.param(kind, path, put, id=f"{kind.__name__}.{path}") for kind in MESSAGES for path, put in float_paths(kind)
]


@pytest.mark.promise("P19")
@pytest.mark.parametrize(("kind", "path", "put"), FLOAT_FIELDS)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_float_that_is_not_finite_is_refused(kind, path, put, bad):
    if path == "phi" and kind.ROS_TYPE and math.isinf(bad):
        pytest.skip("an infinite angle has no quaternion to write")
    if path.endswith("lifetime_s"):
        pytest.skip("a duration in whole nanoseconds is always finite")
    decoded = decode(kind, encode(put(example(kind), bad)))
    assert decoded == Rejected("not finite")


@pytest.mark.promise("P19")
@pytest.mark.parametrize(("kind", "path", "put"), FLOAT_FIELDS)
@pytest.mark.parametrize("huge", [1e308, -1e16])
def test_a_number_so_large_that_its_square_might_overflow_is_refused(kind, path, put, huge):
    if path == "phi" and kind.ROS_TYPE:
        pytest.skip("an angle goes as a quaternion")
    if path.endswith("lifetime_s"):
        pytest.skip("a duration has 32 bits of seconds")
    if path.endswith(COLOURS) and huge > 1e38:
        pytest.skip("a colour has 32 bits")
    assert decode(kind, encode(put(example(kind), huge))) == Rejected("number too large")


@pytest.mark.promise("P19")
def test_what_a_robot_measures_from_itself_is_no_farther_than_that_beliefs_can_be_reported():
    assert decode(BallPercept, encode(BallPercept(0, 1.0, 1e7, 0.1, 0.1, 0.0))) == Rejected("number too large")
    opponent = OpponentPercept(-1e7, 0.0, 0.1, 0.1, 0.1, 0.0)
    assert decode(OpponentPercepts, encode(OpponentPercepts(0, (opponent,)))) == Rejected("number too large")
    unknown = BallPercept(0, 1.0, -1e6, 1e12, 1e12, 1e12)
    assert decode(BallPercept, encode(unknown)) == unknown


@pytest.mark.parametrize(
    "reading",
    [
        m.PoseEstimate(0, 1.0, 2.0, 0.0, -1.0, 0.1, 0.1),
        m.PoseEstimate(0, 1.0, 2.0, 0.0, 0.1, 0.1, -1.0),
        BallPercept(0, 1.0, 2.0, 0.1, -0.1, 0.0),
    ],
)
def test_a_negative_variance_is_refused(reading):
    assert decode(type(reading), encode(reading)) == Rejected("negative variance")


@pytest.mark.promise("P17")
@pytest.mark.parametrize("topic", TOPICS.values(), ids=TOPICS)
def test_a_message_longer_than_its_topic_allows_is_refused(topic):
    assert decode(topic, bytes(topic.max_bytes + 1)) == Rejected("too long")


def test_every_float_of_a_standard_message_must_be_finite_even_those_that_are_not_used():
    whole = encode(m.Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0))
    refused = 0
    for offset in range(4 + 8, len(whole) - 7, 8):
        damaged = bytearray(whole)
        damaged[offset : offset + 8] = np.float64(np.nan).tobytes()
        refused += decode(m.Odometry, bytes(damaged)) == Rejected("not finite")
    assert refused >= 85 - 3  # 85 floats; those beside the strings may fall on another grid


def test_a_quaternion_that_is_no_rotation_is_refused():
    whole = bytearray(encode(m.PoseEstimate(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
    one = whole.index(np.float64(1.0).tobytes())
    whole[one : one + 8] = np.float64(0.9).tobytes()
    assert decode(m.PoseEstimate, bytes(whole)) == Rejected("orientation is not a unit quaternion")


def test_the_heading_of_a_tilted_robot_is_its_yaw():
    """Yaw, then pitch, then roll: localisers in three dimensions write all of them."""
    yaw, pitch, roll = 0.7, 0.2, -0.3
    turns = ((0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)), (0.0, math.sin(pitch / 2), 0.0, math.cos(pitch / 2)))
    heading = Pose3(0.0, 0.0, 0.0, *turns[0]).then(Pose3(0.0, 0.0, 0.0, *turns[1]))
    tilted = heading.then(Pose3(0.0, 0.0, 0.0, math.sin(roll / 2), 0.0, 0.0, math.cos(roll / 2)))
    ros = pose_to_ros(m.PoseEstimate(0, 1.0, 2.0, yaw, 0.1, 0.1, 0.1))
    ros.pose.pose.orientation = type(ros.pose.pose.orientation)(tilted.qx, tilted.qy, tilted.qz, tilted.qw)
    assert pose_from_ros(ros).phi == pytest.approx(yaw)


def test_a_stamp_with_more_than_a_second_of_nanoseconds_is_refused():
    whole = bytearray(encode(m.VelocityCommand(0, 0.1, 0.2)))
    whole[8:12] = (10**9).to_bytes(4, "little")
    assert decode(m.VelocityCommand, bytes(whole)) == Rejected("stamp out of range")
