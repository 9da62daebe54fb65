"""The kitchen robot's belief: pose and velocity of the base, joints of the arm, gripper, objects (paper Table 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from tailor.executive.actions.cubic import Joints
from tailor.executive.belief import planar_ekf
from tailor.executive.belief.angles import difference
from tailor.executive.belief.joint_jumps import jumped
from tailor.executive.belief.planar_ekf import OdometryNoise, Pose
from tailor.executive.domains.kitchen import objects, robot
from tailor.executive.domains.kitchen.objects import Thing
from tailor.schemas.kitchen.kinematics import GRIPPER_MAX_M, JOINT_MAX_RADPS, JOINTS
from tailor.schemas.messages import JointState, Odometry, PoseEstimate, Sample
from tailor.schemas.messages.kitchen import GripperState, ObjectPercepts

ODOMETRY_NOISE = OdometryNoise(along=4e-4, across=1e-4, turn=1e-3, drift=2e-5)
VARIANCES = (1e-8, 25.0)  # m² or rad²; ROS nodes without a covariance send zeros
FIRST_POSES = 6  # percepts that settle the pose
CREDIBLE_MPS, CREDIBLE_RADPS = 1.5, 3.0  # a faster odometry is none
LOST_M, LOST_RAD = 0.6, 0.6  # a pose so far off is not noise
LOST_POSES = 3  # so many such poses in a row relocate the belief
MOTION_LIMIT_S = 0.5  # without readings for longer, the last velocity is not extrapolated
UNKNOWN = Pose(0.0, 0.0, 0.0, (25.0, 0.0, 0.0, 25.0, 0.0, 10.0))
IN_HAND_M = 0.15  # a cup so near the grasp point is the one in the gripper


@dataclass(frozen=True, slots=True)
class KitchenBelief:
    """State variables in the map frame (m, rad, m/s, rad/s); joints from the shoulder outward."""

    time_ns: int = 0
    pose: Pose = UNKNOWN
    v: float = 0.0
    omega: float = 0.0
    moved_ns: int = 0  # arrival of the last odometry
    angles: Joints = robot.HOME
    velocities: Joints = (0.0,) * len(robot.HOME)
    joints_ns: int = 0  # arrival of the last joint state; 0 before the first
    width: float = GRIPPER_MAX_M  # m, between the fingers
    force: float = 0.0  # N, with which they press
    things: tuple[Thing, ...] = ()
    held: str = ""  # name of the cup in the gripper
    poses_seen: int = 0
    poses_doubted: int = 0
    relocated: int = 0  # how often base or arm were moved by others

    @property
    def friction(self) -> Joints:
        """Nominal: the arm's firmware makes up for it."""
        return (1.0,) * len(self.angles)

    def thing(self, name: str) -> Thing | None:
        """The object of a name; None if it was never seen."""
        return objects.named(self.things, name)

    def in_base(self, x: float, y: float) -> tuple[float, float]:
        """A place of the map, in base_link."""
        c, s = math.cos(self.pose.phi), math.sin(self.pose.phi)
        dx, dy = x - self.pose.x, y - self.pose.y
        return c * dx + s * dy, c * dy - s * dx

    @property
    def hand(self) -> tuple[float, float, float]:
        """Place of the grasp point, m in the map frame."""
        ahead, left, z = robot.ARM.forward(self.angles).place
        c, s = math.cos(self.pose.phi), math.sin(self.pose.phi)
        return self.pose.x + c * ahead - s * left, self.pose.y + s * ahead + c * left, z

    @property
    def arm_is_home(self) -> bool:
        """Whether the arm is folded."""
        return max(abs(a - b) for a, b in zip(self.angles, robot.HOME, strict=True)) < robot.HOME_RAD


def ready(belief: KitchenBelief) -> bool:
    """Whether the pose has settled and the arm is known."""
    return belief.poses_seen >= FIRST_POSES and belief.joints_ns > 0


def update(belief: KitchenBelief, now_ns: int, samples: tuple[Sample, ...]) -> KitchenBelief:
    """Filter samples (oldest first) by their time of arrival, then predict to now."""
    for sample in samples:
        message, at_ns = sample.message, sample.arrival_ns
        if isinstance(message, Odometry):
            belief = _drive(belief, at_ns, message)
        elif isinstance(message, PoseEstimate):
            belief = _locate(_advance(belief, at_ns), message)
        elif isinstance(message, JointState):
            belief = _read_joints(belief, at_ns, message)
        elif isinstance(message, GripperState):
            belief = replace(belief, width=message.width, force=message.force)
        elif isinstance(message, ObjectPercepts):
            belief = _advance(belief, at_ns)
            belief = replace(belief, things=objects.see(belief.things, belief.pose, message.objects, belief.time_ns))
    return _with_held(_advance(belief, now_ns))


def _drive(belief: KitchenBelief, at_ns: int, odom: Odometry) -> KitchenBelief:
    """Predict to the arrival of odometry, then take its velocities."""
    if abs(odom.v) > CREDIBLE_MPS or abs(odom.omega) > CREDIBLE_RADPS:
        return belief
    return replace(_advance(belief, at_ns), v=odom.v, omega=odom.omega, moved_ns=at_ns)


def _advance(belief: KitchenBelief, to_ns: int) -> KitchenBelief:
    """Predict to a time; times before the belief's are ignored."""
    if to_ns <= belief.time_ns:
        return belief
    passed_s = 1e-9 * (to_ns - belief.time_ns) if belief.time_ns else 0.0
    stale = to_ns - belief.moved_ns > MOTION_LIMIT_S * 1e9
    v, omega = (0.0, 0.0) if stale else (belief.v, belief.omega)
    pose = planar_ekf.predict(belief.pose, v, omega, passed_s, ODOMETRY_NOISE)
    known = belief.joints_ns > 0 and to_ns - belief.joints_ns <= MOTION_LIMIT_S * 1e9
    move_s = passed_s if known else 0.0
    angles = tuple(q + move_s * w for q, w in zip(belief.angles, belief.velocities, strict=True))
    return replace(belief, time_ns=to_ns, pose=pose, angles=angles)


def _locate(belief: KitchenBelief, seen: PoseEstimate) -> KitchenBelief:
    lower, upper = VARIANCES
    x, y, phi = (min(upper, max(lower, variance)) for variance in (seen.var_x, seen.var_y, seen.var_phi))
    off_m = math.hypot(seen.x - belief.pose.x, seen.y - belief.pose.y)
    lost = off_m > LOST_M or abs(difference(seen.phi, belief.pose.phi)) > LOST_RAD
    if belief.poses_seen and lost and belief.poses_doubted + 1 < LOST_POSES:
        return replace(belief, poses_doubted=belief.poses_doubted + 1)
    if not belief.poses_seen or lost:
        pose = Pose(seen.x, seen.y, seen.phi, (x, 0.0, 0.0, y, 0.0, phi))
        relocated = belief.relocated + (belief.poses_seen > 0)
        return replace(belief, pose=pose, poses_seen=1, poses_doubted=0, relocated=relocated)
    pose = planar_ekf.correct(belief.pose, seen.x, seen.y, seen.phi, (x, y, phi))
    return replace(belief, pose=pose, poses_seen=belief.poses_seen + 1, poses_doubted=0)


def _read_joints(belief: KitchenBelief, at_ns: int, state: JointState) -> KitchenBelief:
    """Ignore a state that lacks one of the arm's joints."""
    if any(name not in state.names for name in JOINTS):
        return belief
    at = [state.names.index(name) for name in JOINTS]
    angles, velocities = (tuple(values[i] for i in at) for values in (state.positions, state.velocities))
    passed_s, known = 1e-9 * (at_ns - belief.joints_ns), belief.joints_ns > 0
    belief = _advance(belief, at_ns)
    relocated = belief.relocated + (known and jumped(belief.angles, angles, passed_s, JOINT_MAX_RADPS))
    return replace(belief, angles=angles, velocities=velocities, joints_ns=at_ns, relocated=relocated)


def _with_held(belief: KitchenBelief) -> KitchenBelief:
    """The belief with the cup between the fingers, which is where the hand is."""
    narrowest, widest = robot.HELD_M
    grasped = bool(belief.held) or belief.force > robot.HELD_N
    if not grasped or not narrowest < belief.width < widest:
        return replace(belief, held="", things=objects.let_go(belief.things, belief.held)) if belief.held else belief
    held = belief.held or _cup_near(belief)
    things = objects.carried(belief.things, held, *belief.hand) if held else belief.things
    return replace(belief, held=held, things=things)


def _cup_near(belief: KitchenBelief) -> str:
    hand = belief.hand
    near = [(math.dist((cup.x, cup.y, cup.z), hand), cup.name) for cup in objects.cups(belief.things)]
    distance, name = min(near, default=(math.inf, ""))
    return name if distance < IN_HAND_M else ""
