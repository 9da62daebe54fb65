"""The arm's belief: joint angles and velocities, straight from the encoders (paper Table 5)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tailor.executive.domains.arm.robot import JOINTS
from tailor.schemas.messages import JointState, Sample

MOTION_LIMIT_S = 0.5  # without encoder readings for longer, the last velocity is not extrapolated
PERIOD_S = 0.1  # of the executive

Joints = tuple[float, ...]  # in the order of JOINTS


@dataclass(frozen=True, slots=True)
class ArmBelief:
    """Angles (rad) and velocities (rad/s) at `time_ns`; `seen_ns` is the arrival of the last encoder reading.

    `command` (rad/s) is the last published one, `acceleration` (rad/s²) its change from the one before.
    """

    time_ns: int = 0
    angles: Joints = (0.0, 0.0)
    velocities: Joints = (0.0, 0.0)
    seen_ns: int | None = None
    command: Joints = (0.0, 0.0)
    acceleration: Joints = (0.0, 0.0)


def update(belief: ArmBelief, now_ns: int, samples: tuple[Sample, ...], command: Joints) -> ArmBelief:
    """Adopt the newest joint state, then predict it to `now_ns` at its velocities."""
    for sample in samples:
        if isinstance(sample.message, JointState):
            belief = _read(belief, sample.arrival_ns, sample.message)
    change = tuple((new - old) / PERIOD_S for new, old in zip(command, belief.command, strict=True))
    return replace(_predicted(belief, now_ns), command=command, acceleration=change)


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
    angles, velocities = tuple(state.positions[i] for i in at), tuple(state.velocities[i] for i in at)
    return replace(belief, time_ns=arrival_ns, angles=angles, velocities=velocities, seen_ns=arrival_ns)


def _predicted(belief: ArmBelief, now_ns: int) -> ArmBelief:
    if belief.seen_ns is None or now_ns <= belief.time_ns:
        return belief
    if now_ns - belief.seen_ns > MOTION_LIMIT_S * 1e9:
        return replace(belief, time_ns=now_ns)
    passed_s = (now_ns - belief.time_ns) * 1e-9
    moved = (angle + passed_s * velocity for angle, velocity in zip(belief.angles, belief.velocities, strict=True))
    return replace(belief, time_ns=now_ns, angles=tuple(moved))
