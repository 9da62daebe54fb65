"""A message with a number that is not finite is refused by its field, so that people find who computes it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.schemas import standard
from tailor.schemas.bad_field import MAX_INDEX, not_finite_field
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import JointState, Odometry, PoseEstimate, VelocityCommand
from tailor.schemas.own import example
from tailor.schemas.typesystem import ros_type, to_bytes

JOINTS = JointState(0, ("a", "b"), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0))


@pytest.mark.parametrize(
    ("message", "where"),
    [
        (replace(example(Odometry), y=math.inf), "pose.pose.position.y"),
        (replace(example(Odometry), omega=math.nan), "twist.twist.angular.z"),
        (replace(example(PoseEstimate), var_phi=math.nan), "pose.covariance[35]"),
        (replace(example(VelocityCommand), v=-math.inf), "twist.linear.x"),
        (replace(JOINTS, velocities=(0.0, math.nan)), "velocity[1]"),
    ],
)
def test_the_refusal_names_the_field(message, where):
    refused = decode(type(message), encode(message))
    assert refused == Rejected("not finite"), "it is counted by the reason alone"
    assert (refused.where, refused.text) == (where, f"not finite ({where})")


def test_a_field_that_no_robot_of_ours_reads_is_named_as_well():
    ros = standard.odometry_to_ros(example(Odometry))
    ros.twist.covariance[7] = np.nan
    assert decode(Odometry, to_bytes(ros, ros_type(Odometry))).text == "not finite (twist.covariance[7])"


def test_other_refusals_name_none():
    assert decode(Odometry, encode(replace(example(Odometry), x=1e300))).text == "number too large"
    assert decode(Odometry, b"").text == "malformed"


def test_far_elements_are_not_told_apart():
    assert not_finite_field([0.0] * (MAX_INDEX + 5) + [math.nan]) == "[…]"
