"""What the PowerCube arm looks like: six modules in a row, four of them braked, and the pen. Metres, radians.

Lengths and braked angles are those of simnodes/powercube/scene.xml.
"""

from __future__ import annotations

from collections.abc import Mapping

from tailor.schemas.messages import JointState, Message
from tailor.schemas.messages.scenes import FrameTransform, Shape
from tailor.schemas.packages.pose3 import Pose3, turned
from tailor.schemas.packages.scene import BASE, DARK, GREY, ORANGE, Scene, box, cylinder, frame, pose_of, sphere

VIEW = "behind"  # the arm stretches along x and writes to the right and upward

SHOULDER_M = 1.25  # above the floor
# joint, distance along x from the joint before, axis, angle where it is braked, radius of its module
MODULES = (
    ("pan", 0.0, (0.0, 0.0, -1.0), None, 0.055),
    ("lift", 0.0, (0.0, -1.0, 0.0), None, 0.055),
    ("elbow", 0.22, (0.0, -1.0, 0.0), -0.35, 0.045),
    ("forearm", 0.2, (1.0, 0.0, 0.0), 0.0, 0.045),
    ("wrist", 0.16, (0.0, -1.0, 0.0), 0.35, 0.035),
    ("hand", 0.08, (1.0, 0.0, 0.0), 0.0, 0.035),
)
PEN_M = 0.12  # from the last joint to the tip
LINKS = (("lift", 0.22), ("elbow", 0.2), ("forearm", 0.16), ("wrist", 0.08), ("hand", PEN_M))


def of_belief(values: Mapping[str, float]) -> Scene:
    """The believed angles."""
    return Scene(_frames({"pan": values["a"], "lift": values["b"]}), ARM, "pen")


def of_truth(message: Message) -> Scene:
    """The true angles of all joints."""
    if not isinstance(message, JointState) or not {"pan", "lift"} <= set(message.names):
        return Scene()
    return Scene(_frames(dict(zip(message.names, message.positions, strict=True))), ARM, "pen")


def of_subgoal(values: Mapping[str, float]) -> Pose3 | None:
    """Where the pen is at these angles."""
    if not {"a", "b"} <= values.keys():
        return None
    pose = Pose3()
    for each in _frames({"pan": values["a"], "lift": values["b"]}):
        pose = pose.then(pose_of(each))
    return pose


def _frames(angles: Mapping[str, float]) -> tuple[FrameTransform, ...]:
    """The chain from map to pen; each frame is the parent of the next."""
    chain, parent = [frame(BASE, Pose3(z=SHOULDER_M))], BASE
    for joint, ahead_m, axis, braked, _ in MODULES:
        angle = angles.get(joint, 0.0 if braked is None else braked)
        chain.append(frame(joint, turned(axis, angle, (ahead_m, 0.0, 0.0)), parent))
        parent = joint
    return (*chain, frame("pen", Pose3(PEN_M), parent))


def _arm() -> tuple[Shape, ...]:
    links = [
        box(f"{joint} link", (length_m, 0.045, 0.045), Pose3(length_m / 2), GREY, joint) for joint, length_m in LINKS
    ]
    modules = [sphere(joint, radius_m, Pose3(), DARK, joint) for joint, *_, radius_m in MODULES]
    return (cylinder("column", 0.06, SHOULDER_M, Pose3(z=-SHOULDER_M / 2)), *links, *modules, _TIP)


_TIP = sphere("tip", 0.012, Pose3(), ORANGE, "pen")
ARM = _arm()
