"""Command outlets of a robot, e.g. base, arm and gripper, each with a topic, axes and a message of its own.

A robot with one outlet declares `axes`, `command_topic` and `message` in its domain. One with several declares
`outlets` as well, in the order of `axes`; all of them are published in each tick, behind one guard.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.domain import Axis, Domain
from tailor.executive.interfaces.domain_results import kept_at
from tailor.executive.interfaces.results import name_of, wrong_result
from tailor.executive.interfaces.values import Belief
from tailor.schemas.messages import Message
from tailor.schemas.topics import TOPICS

Command = tuple[float, ...]  # one value per axis


@dataclass(frozen=True, slots=True)
class Outlet:
    """One outlet.

    Attributes:
      name: As in Action.drives, e.g. "gripper".
      topic: Topic of its command, a key of tailor.schemas.topics.TOPICS.
      axes: Its axes.
      message: Makes the message of the topic's type from one finite value per axis, and a stamp in ns.
    """

    name: str
    topic: str
    axes: tuple[Axis, ...]
    message: Callable[[Command, int], Message]


def outlets_of(domain: Domain) -> tuple[Outlet, ...]:
    """All outlets of a robot, in the order of the domain's axes."""
    declared: tuple[Outlet, ...] = getattr(domain, "outlets", ())
    return declared or (Outlet("", domain.command_topic, domain.axes, domain.message),)


def messages_of(domain: Domain, command: Command, stamp_ns: int) -> tuple[tuple[str, Message], ...]:
    """Topic and message of each outlet for a command of all axes.

    Raises:
      UsageError: A package's method returns no message of the topic's type.
    """
    messages, first = [], 0
    for outlet in outlets_of(domain):
        last = first + len(outlet.axes)
        message: Any = outlet.message(command[first:last], stamp_ns)
        if not isinstance(message, TOPICS[outlet.topic].type):
            expected = f"a {TOPICS[outlet.topic].type.__name__} by the topic {outlet.topic}"
            raise wrong_result(f"the package of {domain.name}: {name_of(outlet.message)}", message, expected)
        messages.append((outlet.topic, message))
        first = last
    return tuple(messages)


def driven_axes(domain: Domain, action: Action) -> tuple[Axis, ...]:
    """Axes that an action's controller commands, in the order of the domain's axes."""
    if not action.drives:
        return domain.axes
    return tuple(axis for outlet in outlets_of(domain) if outlet.name in action.drives for axis in outlet.axes)


def at_rest(axes: tuple[Axis, ...], last: Command = ()) -> Command:
    """The command that brings the robot to rest: zero, or for an axis that keeps its set-point the last one."""
    before = last or tuple(0.0 if axis.kept is None else axis.kept for axis in axes)
    return tuple(0.0 if axis.kept is None else value for axis, value in zip(axes, before, strict=True))


def staying(domain: Domain, belief: Belief, last: Command) -> Command:
    """The command that moves no axis: rest, where one that keeps its set-point gets the place at which it is.

    One whose place the domain does not know keeps its set-point of `last`. One that is measured beyond its limits, as
    the noise of an open gripper is, gets the limit.
    """
    rest = at_rest(domain.axes, last)
    rows = zip(domain.axes, kept_at(domain, belief) or rest, rest, strict=True)
    return tuple(
        min(axis.upper, max(axis.lower, at)) if axis.kept is not None and math.isfinite(at) else old
        for axis, at, old in rows
    )


def completed(domain: Domain, action: Action, command: Command, last: Command) -> Command:
    """A command of all axes from that of the driven ones: the others rest. One of a wrong length is not completed."""
    driven = driven_axes(domain, action)
    if not action.drives or len(command) != len(driven):
        return command
    values = dict(zip((axis.name for axis in driven), command, strict=True))
    rest = at_rest(domain.axes, last)
    return tuple(values.get(axis.name, value) for axis, value in zip(domain.axes, rest, strict=True))
