"""Messages of sensors that are no measurements: incomplete joint states, and motion that the robot is not capable of.

Others are known to the robot's domain alone, see tailor.executive.interfaces.domain_results.measurement_fault.

A belief ignores them, but they would keep the topic fresh: an arm was driven blind to the ends of its joints, and a
base arrived at full speed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from tailor.executive.core.sensing.repeats import Repeat, repeated
from tailor.executive.core.sensing.travel import Travel, travelled
from tailor.executive.interfaces.domain import Domain
from tailor.executive.interfaces.outlet import outlets_of
from tailor.schemas.messages import JointState, Message, Odometry, PoseEstimate, Sample, VelocityCommand

MAX_POSITION = 1e6  # rad or m; wheels count their turns: 100 km
MAX_VELOCITY = 1e3  # rad/s or m/s
MAX_PLACE_M = 1e8  # from the origin of a map, which may be that of a country
FASTER, MARGIN = 1.6, 0.05  # odometry may exceed the limits of a command by this factor, and by this in m/s and rad/s

Speeds = tuple[float, float]  # m/s, rad/s


@dataclass(frozen=True, slots=True)
class Measurements:
    """What is known of measurements, by key.

    Attributes:
      joints: Names in the first measurement; those of another sender, e.g. of a driver after its restart, are the same.
      faults: Why the newest message is no measurement; keys whose newest message is one are left out.
      travel: Of a base that is commanded by velocities: its way, by poses and by odometry.
      repeats: Of joint states: the newest of each key, and how far it would have moved since it repeats itself.
    """

    joints: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    faults: Mapping[str, str] = field(default_factory=dict)
    travel: Travel = field(default_factory=Travel)
    repeats: Mapping[str, Repeat] = field(default_factory=dict)


def without_faulty(
    known: Measurements,
    samples: tuple[Sample, ...],
    fastest: Speeds | None = None,
    judge: Callable[[Message], str] = lambda message: "",
) -> tuple[Measurements, tuple[Sample, ...]]:
    """What is known after `samples`, and those that are measurements.

    Args:
      known: What was known before them.
      samples: Of the robot's sensors, in order of arrival.
      fastest: Speeds that odometry may have; None: any.
      judge: Why the robot's domain takes a message for none; empty: it does not.
    """
    joints, faults, repeats, travel, kept = (
        dict(known.joints),
        dict(known.faults),
        dict(known.repeats),
        known.travel,
        [],
    )
    for sample in samples:
        faults.pop(sample.key, None)
        fault = _fault(sample.message, joints.get(sample.key, ()), fastest) or judge(sample.message)
        if not fault and fastest is not None:
            travel, fault = travelled(travel, sample.arrival_ns, sample.message)
        if not fault and isinstance(sample.message, JointState):
            repeats[sample.key], fault = repeated(repeats.get(sample.key), sample.arrival_ns, sample.message)
        if fault:
            faults[sample.key] = fault
            continue
        if isinstance(sample.message, JointState):
            joints.setdefault(sample.key, sample.message.names)
        kept.append(sample)
    return Measurements(joints, faults, travel, repeats), tuple(kept)


def fastest_of(domain: Domain) -> Speeds | None:
    """Speeds that the odometry of a robot may have; None if its base is not commanded by velocities.

    Where it is commanded along one of them alone, the other one may be any.
    """
    for outlet in outlets_of(domain):
        ends = (tuple(axis.lower for axis in outlet.axes), tuple(axis.upper for axis in outlet.axes))
        commands = [outlet.message(end, 0) for end in ends]
        moves = [(abs(c.v), abs(c.omega)) for c in commands if isinstance(c, VelocityCommand)]
        if moves:
            v, omega = (FASTER * max(each) + MARGIN if max(each) else math.inf for each in zip(*moves, strict=True))
            return v, omega
    return None


def _fault(message: Message, joints: tuple[str, ...], fastest: Speeds | None) -> str:
    if isinstance(message, JointState):
        return _joint_fault(message, joints)
    if isinstance(message, PoseEstimate):
        return _beyond((("x", message.x, MAX_PLACE_M), ("y", message.y, MAX_PLACE_M)))
    if isinstance(message, Odometry) and fastest is not None:
        return _beyond((("v", message.v, fastest[0]), ("omega", message.omega, fastest[1])))
    return ""


def _joint_fault(state: JointState, joints: tuple[str, ...]) -> str:
    lacking = [name for name in joints if name not in state.names]
    if lacking or not state.names:
        return f"lacks {lacking[0] if lacking else 'joints'}"
    twice = next((name for name in state.names if state.names.count(name) > 1), None)
    if twice is not None:
        return f"has {twice} twice"
    positions = ((name, value, MAX_POSITION) for name, value in zip(state.names, state.positions, strict=True))
    velocities = ((name, value, MAX_VELOCITY) for name, value in zip(state.names, state.velocities, strict=True))
    return _beyond((*positions, *velocities))


def _beyond(rows: Iterable[tuple[str, float, float]]) -> str:
    return next((f"has {name} at {value:g}" for name, value, most in rows if not abs(value) <= most), "")
