"""Joint states that are no measurements: one that lacks a joint, names one twice, or has a value that no joint has.

A belief ignores them, but they would keep the topic fresh: an arm was driven blind to the ends of its joints.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from tailor.schemas.messages import JointState, Sample

MAX_POSITION = 1e6  # rad or m; wheels count their turns: 100 km
MAX_VELOCITY = 1e3  # rad/s or m/s


@dataclass(frozen=True, slots=True)
class JointReadings:
    """What is known of joint states, by key.

    Attributes:
      joints: Names in the first measurement; those of another sender, e.g. of a driver after its restart, are the same.
      faults: Why the newest message is no measurement; keys whose newest message is one are left out.
    """

    joints: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    faults: Mapping[str, str] = field(default_factory=dict)


def without_faulty(
    readings: JointReadings, keys: Collection[str], samples: tuple[Sample, ...]
) -> tuple[JointReadings, tuple[Sample, ...]]:
    """The readings after `samples`, and the samples without joint states under `keys` that are no measurements."""
    joints, faults, kept = dict(readings.joints), dict(readings.faults), []
    for sample in samples:
        if isinstance(sample.message, JointState) and sample.key in keys:
            faults.pop(sample.key, None)
            if fault := _fault(sample.message, joints.get(sample.key, ())):
                faults[sample.key] = fault
                continue
            joints.setdefault(sample.key, sample.message.names)
        kept.append(sample)
    return JointReadings(joints, faults), tuple(kept)


def _fault(state: JointState, joints: tuple[str, ...]) -> str:
    lacking = [name for name in joints if name not in state.names]
    if lacking or not state.names:
        return f"lacks {lacking[0] if lacking else 'joints'}"
    twice = next((name for name in state.names if state.names.count(name) > 1), None)
    if twice is not None:
        return f"has {twice} twice"
    for values, most in ((state.positions, MAX_POSITION), (state.velocities, MAX_VELOCITY)):
        for name, value in zip(state.names, values, strict=True):
            if abs(value) > most:
                return f"has {name} at {value:g}"
    return ""
