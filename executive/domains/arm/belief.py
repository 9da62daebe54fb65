"""The arm's belief: joint angles and velocities, filtered from encoders and commands (paper Table 5), and friction."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tailor.executive.belief.joint_jumps import jumped
from tailor.executive.domains.arm.load import Joints, observed_friction
from tailor.executive.domains.arm.robot import JOINTS, V_MAX_RADPS
from tailor.schemas.messages import JointState, Sample

MOTION_LIMIT_S = 0.5  # without encoder readings for longer, the last velocity is not extrapolated
PERIOD_S = 0.1  # of the executive
# gains of the stationary Kalman filter, ten readings a second: the driver follows a command within 2 mrad and
# 10 mrad/s, encoders are read within 0.7 mrad, tachometers within 10 mrad/s
ANGLE_GAIN, VELOCITY_GAIN = 0.85, 0.5
ASTRAY_RAD, ASTRAY_RADPS = 0.02, 0.1  # beyond this the driver does not follow: readings alone are believed
FRICTION_GAIN = 0.4  # friction changes within minutes, but a reading of it is 8 % off
FRICTION_RANGE = (0.4, 2.5)


@dataclass(frozen=True, slots=True)
class ArmBelief:
    """Angles (rad) and velocities (rad/s) at `time_ns`; `seen_ns` is the arrival of the last encoder reading.

    `command` (rad/s) is the last published one, `acceleration` (rad/s²) its change from the one before. `friction` of
    each joint is a multiple of the nominal.
    """

    time_ns: int = 0
    angles: Joints = (0.0, 0.0)
    velocities: Joints = (0.0, 0.0)
    seen_ns: int | None = None
    command: Joints = (0.0, 0.0)
    acceleration: Joints = (0.0, 0.0)
    friction: Joints = (1.0, 1.0)
    relocated: int = 0  # how often the joints were found where they cannot have moved to


def update(belief: ArmBelief, now_ns: int, samples: tuple[Sample, ...], command: Joints) -> ArmBelief:
    """Predict with the last command, correct by the newest joint state, then predict to `now_ns`."""
    change = tuple((new - old) / PERIOD_S for new, old in zip(command, belief.command, strict=True))
    belief = replace(belief, command=command, acceleration=change)
    for sample in samples:
        if isinstance(sample.message, JointState):
            belief = _read(belief, sample.arrival_ns, sample.message)
    return _predicted(belief, now_ns)


def ahead(belief: ArmBelief) -> tuple[Joints, Joints]:
    """Predict angles and velocities one period ahead, where the next action will begin."""
    rows = tuple(zip(belief.angles, belief.velocities, belief.acceleration, strict=True))
    angles = tuple(q + PERIOD_S * (v + 0.5 * PERIOD_S * a) for q, v, a in rows)
    return angles, tuple(v + PERIOD_S * a for _, v, a in rows)


def _read(belief: ArmBelief, arrival_ns: int, state: JointState) -> ArmBelief:
    """Ignore a state that lacks one of the writing joints or is older than the last one."""
    if any(name not in state.names for name in JOINTS) or arrival_ns < (belief.seen_ns or 0):
        return belief
    at = [state.names.index(name) for name in JOINTS]
    angles, velocities = (tuple(values[i] for i in at) for values in (state.positions, state.velocities))
    if belief.seen_ns is not None:
        passed_s = 1e-9 * (arrival_ns - belief.seen_ns)
        before = _predicted(belief, arrival_ns).angles
        belief = replace(belief, relocated=belief.relocated + jumped(before, angles, passed_s, V_MAX_RADPS))
    if belief.seen_ns is not None and arrival_ns - belief.time_ns < MOTION_LIMIT_S * 1e9:
        angles, velocities = _filtered(belief, 1e-9 * (arrival_ns - belief.time_ns), angles, velocities)
    belief = replace(belief, time_ns=arrival_ns, angles=angles, velocities=velocities, seen_ns=arrival_ns)
    return _with_friction(belief, tuple(state.efforts[i] for i in at)) if state.efforts else belief


def _filtered(belief: ArmBelief, passed_s: float, angles: Joints, velocities: Joints) -> tuple[Joints, Joints]:
    """The measured state, weighed against the one to which the command led."""
    believed = []
    rows = zip(belief.angles, belief.velocities, belief.command, angles, velocities, strict=True)
    for q, v, command, angle, velocity in rows:
        then = v + (command - v) * min(1.0, passed_s / PERIOD_S)  # set-points are joined by straight lines
        angle_error, velocity_error = angle - q - 0.5 * passed_s * (v + then), velocity - then
        if abs(angle_error) > ASTRAY_RAD or abs(velocity_error) > ASTRAY_RADPS:
            believed.append((angle, velocity))
        else:
            lag = (1.0 - ANGLE_GAIN) * angle_error, (1.0 - VELOCITY_GAIN) * velocity_error
            believed.append((angle - lag[0], velocity - lag[1]))
    (a, wa), (b, wb) = believed
    return (a, b), (wa, wb)


def _with_friction(belief: ArmBelief, efforts: Joints) -> ArmBelief:
    observed = observed_friction(belief.angles, belief.velocities, belief.acceleration, efforts)
    lowest, highest = FRICTION_RANGE
    friction = tuple(
        old if new is None else old + FRICTION_GAIN * (max(lowest, min(highest, new)) - old)
        for old, new in zip(belief.friction, observed, strict=True)
    )
    return replace(belief, friction=friction)


def _predicted(belief: ArmBelief, now_ns: int) -> ArmBelief:
    if belief.seen_ns is None or now_ns <= belief.time_ns:
        return belief
    if now_ns - belief.seen_ns > MOTION_LIMIT_S * 1e9:
        return replace(belief, time_ns=now_ns)
    passed_s = (now_ns - belief.time_ns) * 1e-9
    moved = (angle + passed_s * velocity for angle, velocity in zip(belief.angles, belief.velocities, strict=True))
    return replace(belief, time_ns=now_ns, angles=tuple(moved))
