"""Topics of the kitchen robot alone, beside cmd_vel, joint_cmd, odom, pose and joint_states."""

from __future__ import annotations

from tailor.schemas.messages.kitchen import GripperCommand, GripperState, KitchenTruth, ObjectPercepts
from tailor.schemas.packages.topic import Topic

BLIND_S = 1.0  # ten pictures; an empty one is a measurement, too

TOPICS = {
    "gripper_cmd": Topic("{robot}/gripper_cmd", GripperCommand, 10, "executive", priority="real_time"),
    "gripper": Topic("{robot}/gripper", GripperState, 20, "driver", 0.5),
    "objects": Topic("{robot}/objects", ObjectPercepts, 10, "driver", BLIND_S),
    "kitchen_truth": Topic("{robot}/sim/kitchen", KitchenTruth, 10, "simulator"),
}
