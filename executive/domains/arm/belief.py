"""The arm's belief: joint angles and velocities, straight from the encoders (paper Table 5)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from executive.domains.arm.robot import JOINTS
from schemas.messages import JointState, Sample

MOTION_LIMIT_S = 0.5  # without encoders for longer, the last velocity says nothing


@dataclass(frozen=True, slots=True)
class ArmBelief:
    """Angles (rad) and velocities (rad/s) in the order of JOINTS, at `time_ns`; `seen_ns` is the last encoder's."""

    time_ns: int = 0
    angles: tuple[float, ...] = (0.0, 0.0)
    velocities: tuple[float, ...] = (0.0, 0.0)
    seen_ns: int | None = None


def update(belief: ArmBelief, now_ns: int, samples: tuple[Sample, ...]) -> ArmBelief:
    """Take the newest joint state over, then predict to now at its velocities."""
    for sample in samples:
        if isinstance(sample.message, JointState):
            belief = _read(belief, sample.arrival_ns, sample.message)
    return _predicted(belief, now_ns)


def _read(belief: ArmBelief, arrival_ns: int, state: JointState) -> ArmBelief:
    """A state that lacks one of our joints, or is older than the last one, tells nothing."""
    if any(name not in state.names for name in JOINTS) or arrival_ns < (belief.seen_ns or 0):
        return belief
    at = [state.names.index(name) for name in JOINTS]
    angles = tuple(state.positions[i] for i in at)
    return ArmBelief(arrival_ns, angles, tuple(state.velocities[i] for i in at), arrival_ns)


def _predicted(belief: ArmBelief, now_ns: int) -> ArmBelief:
    if belief.seen_ns is None or now_ns <= belief.time_ns:
        return belief
    if now_ns - belief.seen_ns > MOTION_LIMIT_S * 1e9:
        return replace(belief, time_ns=now_ns)
    passed_s = (now_ns - belief.time_ns) * 1e-9
    moved = (angle + passed_s * velocity for angle, velocity in zip(belief.angles, belief.velocities, strict=True))
    return replace(belief, time_ns=now_ns, angles=tuple(moved))
