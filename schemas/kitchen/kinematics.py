"""The B21: footprint, arm and gripper. Metres, radians; frame base_link: on the floor, x ahead, z upward.

All joint angles zero: the arm stretches straight ahead. `simnodes/b21/b21.urdf` is the same robot, which a test checks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tailor.schemas.packages.pose3 import Pose3, Vector, turned

BASE_RADIUS_M = 0.265
BASE_HEIGHT_M = 1.06
V_MAX_MPS = 0.6
OMEGA_MAX_RADPS = 1.0


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint of the arm.

    Attributes:
      name: As in joint states and commands.
      ahead_m: Distance along x from the joint before.
      axis: Unit axis in the frame of the joint before.
      lower, upper: Range of its angle, rad.
    """

    name: str
    ahead_m: float
    axis: Vector
    lower: float
    upper: float


SHOULDER: Vector = (0.18, 0.0, 1.15)  # where pan and lift cross
LEFT_DOWN: Vector = (0.0, -1.0, 0.0)  # positive angles lift
UPPER_ARM_M = 0.38  # shoulder to elbow
FOREARM_M = 0.34  # elbow to wrist
HAND_M = 0.18  # wrist to the grasp point between the fingers
ARM = (
    Joint("pan", 0.0, (0.0, 0.0, 1.0), -2.0, 2.0),
    Joint("lift", 0.0, LEFT_DOWN, -1.2, 2.2),
    Joint("elbow", UPPER_ARM_M, LEFT_DOWN, -2.7, 0.3),
    Joint("forearm", 0.2, (1.0, 0.0, 0.0), -2.8, 2.8),
    Joint("wrist", FOREARM_M - 0.2, LEFT_DOWN, -2.6, 2.6),
    Joint("hand", 0.06, (1.0, 0.0, 0.0), -2.8, 2.8),
)
TOOL_M = HAND_M - 0.06  # from the last joint to the grasp point
JOINTS = tuple(joint.name for joint in ARM)
JOINT_MAX_RADPS = 1.2
HOME = (0.0, 0.64945, -2.46576, 0.0, 1.81631, 0.0)  # folded over the base: hand level, fingers ahead, above every table

GRIPPER_MAX_M = 0.12  # width between the fingers
GRIPPER_MPS = 0.1
FINGER_M = (0.09, 0.012, 0.03)  # length, thickness, height; they end 0.03 m beyond the grasp point
CAMERA: Vector = (0.0, 0.0, 1.45)
HALF_VIEW_RAD = 0.87  # to either side of straight ahead
VIEW_M = (0.35, 5.0)  # horizontal distances from the camera that it sees


def joint_frames(angles: Sequence[float]) -> tuple[Pose3, ...]:
    """Frames of the six joints, turned by their angles (rad), and of the tool (grasp point), in base_link.

    The axis of joint k is `ARM[k].axis` in its own frame as well: a turn leaves its axis where it is.
    """
    pose = Pose3(*SHOULDER)
    frames = []
    for joint, angle in zip(ARM, angles, strict=True):
        pose = pose.then(turned(joint.axis, angle, (joint.ahead_m, 0.0, 0.0)))
        frames.append(pose)
    return (*frames, pose.then(Pose3(TOOL_M)))


def tool_pose(angles: Sequence[float]) -> Pose3:
    """Pose of the grasp point in base_link; fingers point along its x axis and close along its y axis."""
    return joint_frames(angles)[-1]
