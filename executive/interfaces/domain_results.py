"""What the methods of a domain return, checked: the package of a robot is named where it returns anything else.

Of a tick's facts only those are looked at that are new; all checks of a tick take microseconds.
"""

from __future__ import annotations

from numbers import Integral, Real
from typing import Any

import numpy as np

from tailor.executive.interfaces.domain import Domain, LabelQuery, Scenario
from tailor.executive.interfaces.results import is_row_of_numbers, wrong_result
from tailor.executive.interfaces.values import Belief, Fact, Interval
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Message, Sample

DECLARED = "(executive/interfaces/domain.py)"


def first_belief(domain: Domain) -> Belief:
    """`initial_belief`."""
    belief = domain.initial_belief()
    if belief is None:
        raise _wrong(domain, "initial_belief", belief, "a belief")
    return belief


def updated(
    domain: Domain, belief: Belief, now_ns: int, samples: tuple[Sample, ...], command: tuple[float, ...]
) -> Belief:
    """`update`."""
    belief = domain.update(belief, now_ns, samples, command)
    if belief is None:
        raise _wrong(domain, "update", belief, "a belief")
    return belief


def is_ready(domain: Domain, belief: Belief) -> bool:
    """`ready`. Nothing, as without a `return`, would hold the robot for ever."""
    ready: Any = domain.ready(belief)
    if not isinstance(ready, bool | np.bool_):
        raise _wrong(domain, "ready", ready, "True or False")
    return bool(ready)


def telemetry(domain: Domain, belief: Belief) -> tuple[float, ...]:
    """`belief_values`; whether they are finite is a matter of the belief, not of the method."""
    values: Any = domain.belief_values(belief)
    if not is_row_of_numbers(values):
        raise _wrong(domain, "belief_values", values, "a tuple of numbers")
    return tuple(values)


def anchored(domain: Domain, belief: Belief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
    """`anchor`."""
    facts: Any = domain.anchor(belief, scenario, remembered)
    if not isinstance(facts, frozenset | set):
        raise _wrong(domain, "anchor", facts, "a frozenset of facts")
    for fact in facts - remembered:
        if not (isinstance(fact, tuple) and fact and all(isinstance(word, str) for word in fact)):
            raise _wrong(domain, "anchor", fact, 'facts such as ("robot", "pos1")', "the fact ")
    return frozenset(facts)


def value_of(domain: Domain, query: LabelQuery) -> Interval | None:
    """`value`."""
    interval: Any = domain.value(query)
    if interval is None:
        return None
    if not isinstance(interval, Interval) or not (
        isinstance(interval.lower, Real) and isinstance(interval.upper, Real)
    ):
        raise _wrong(domain, f"value of {query.quantity} of {query.label}", interval, "an Interval of numbers or None")
    return interval


def relocations(domain: Domain, belief: Belief) -> int:
    """How often the robot was found where it cannot have driven; 0 for a domain without a method of this name.

    Decisions do not outlast a relocation: they were made for the place before.
    """
    method = getattr(domain, "relocations", None)
    if method is None:
        return 0
    count: Any = method(belief)
    if not isinstance(count, Integral):
        raise _wrong(domain, "relocations", count, "a whole number")
    return int(count)


def measurement_fault(domain: Domain, belief: Belief, message: Message) -> str:
    """Why a message of a sensor is no measurement; empty if it is one, or for a domain without such a method.

    The belief does not get such a message, and its topic does not stay fresh by it.
    """
    judge = getattr(domain, "measurement_fault", None)
    if judge is None:
        return ""
    fault: Any = judge(belief, message)
    if not isinstance(fault, str):
        raise _wrong(domain, "measurement_fault", fault, "text, empty for a measurement")
    return fault


def kept_at(domain: Domain, belief: Belief) -> tuple[float, ...]:
    """A set-point for each axis at which those that are kept stay where they are; () for a domain without `kept`.

    Before a driver obeys, the command follows them: people may have moved a gripper by hand.
    """
    stay = getattr(domain, "kept", None)
    if stay is None:
        return ()
    kept: Any = stay(belief)
    if not is_row_of_numbers(kept) or len(kept) not in (0, len(domain.axes)):
        raise _wrong(domain, "kept", kept, f"one set-point for each of {len(domain.axes)} axes")
    return tuple(kept)


def _wrong(domain: Domain, method: str, result: Any, expected: str, which: str = "") -> UsageError:
    return wrong_result(f"the package of {domain.name}: {method}", result, f"{expected} {DECLARED}", which)
