"""Reads a plan in VHPOP's plain or causal-link form, or as the competitions' sequence or timed list of actions."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from fractions import Fraction

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Literal
from tailor.executive.planning.pddl.times import NANOSECOND_S, exact
from tailor.executive.planning.plans.plan import DEFAULT_TICK_S, GOAL, Link, Plan, Step
from tailor.executive.planning.plans.schedule import levels
from tailor.schemas.errors import UsageError

MAX_CHARACTERS = 1_000_000  # a plan of a thousand steps has a tenth of that
MAX_LINES = 20_000
MAX_STEPS = 200  # as many as our own plans may have
MAX_DIGITS = 12  # of a number; a plan of a thousand years in ticks has as many
MAX_BOUND_DIGITS = 19  # of a bound in nanoseconds, which takes as long as MAX_DIGITS of ticks
_NAME = r"[^\s()]+"
_FACT = re.compile(rf"\(\s*({_NAME}(?:\s+{_NAME})*)\s*\)")
_PLAIN = re.compile(r"(\d+(?:\.\d+)?)\s*:\s*(\(.*\))\s*(?:\[(\d+(?:\.\d+)?)\])?")
_STEP = re.compile(r"Step\s+(\d+)\s*:\s*(\(.*\))")
_LINK = re.compile(r"(\d+)\s*->\s*(\(.*\))")
_PAIR = re.compile(r"(?<!\d)(\d+)<(\d+)")  # from the first digit on, or a long number would take minutes
_INTEGER = re.compile(r"-?[0-9]+")
_DECIMAL = re.compile(r"[0-9]+(?:\.[0-9]*)?(?:e[-+]?[0-9]+)?")
_SKIPPED = ("Time:", "Makespan:", "Parsing time:", "Memory used")


class PlanTextError(UsageError):
    """Text that is not a plan in either form; the message names the line."""


@dataclass(slots=True)
class _Draft:
    """The parts of a plan read so far."""

    problem: str = ""
    initial: tuple[Fact, ...] = ()
    plain: list[Step] = field(default_factory=list)
    instant: set[int] = field(default_factory=set)  # steps in the plain form without a duration
    actions: dict[int, Fact] = field(default_factory=dict)
    links: list[Link] = field(default_factory=list)
    orderings: list[tuple[int, int]] = field(default_factory=list)
    bounds: list[tuple[int | None, ...]] = field(default_factory=list)
    bindings: list[str] = field(default_factory=list)
    tick_s: float = DEFAULT_TICK_S
    decimals: int = 0  # of the times in the plain form
    consumer: int | None = None
    part: str = ""  # "orderings" or "bindings" while their lines follow
    has_goal: bool = False


def parse_plan(text: str) -> Plan:
    """The plan in a text of this planner, a recording or an external planner.

    The plain form, and the competitions' lines `(action args)` or `START: (action args) [DURATION]`, have no initial
    state, links or orderings; their steps are numbered in their order, and their tick is 0.01 s or the last digit
    printed. In a list with durations, steps without one take no time. Start times and durations of a durative
    causal-link form are those of the printed bounds, in ticks of 0.01 s unless the text has a line "tolerance = ...".

    Args:
      text: One of the forms; "Initial  :" and the paper's "Initial 0 :" are both accepted.

    Returns:
      The plan, not validated.

    Raises:
      PlanTextError: No plan, or a malformed one, or a text beyond the limits.
    """
    lines = text[: MAX_CHARACTERS + 1].splitlines()
    if len(text) > MAX_CHARACTERS or len(lines) > MAX_LINES:
        raise PlanTextError(f"plan text: longer than {MAX_CHARACTERS} characters or {MAX_LINES} lines")
    draft = _Draft()
    for row, line in enumerate(lines, 1):
        try:
            _read_line(line.rstrip(), draft)
        except ValueError as error:
            raise PlanTextError(f"plan text, line {row}: {error}") from None
        if max(len(draft.actions), len(draft.plain)) > MAX_STEPS:  # at once: an executive reads it within a tick
            raise PlanTextError(f"plan text: more than {MAX_STEPS} steps")
    if draft.has_goal:
        return _from_links(draft)
    if draft.plain:
        return _from_plain(draft)
    raise PlanTextError("plan text: expected steps such as '1:(action args)' or a part 'Goal     :'; there is no plan")


def _read_line(line: str, draft: _Draft) -> None:
    stripped = line.strip()
    if not stripped or stripped.startswith(_SKIPPED):
        return
    if stripped.startswith(";"):
        if not draft.problem:
            draft.problem = stripped[1:]
    elif stripped.startswith("Initial"):
        draft.initial = tuple(_facts(stripped.partition(":")[2]))
    elif stripped.startswith("Goal"):
        draft.consumer, draft.has_goal = GOAL, True
    elif stripped.startswith("orderings"):
        draft.part = "orderings"
        draft.orderings += [(_whole(i), _whole(j)) for i, j in _PAIR.findall(stripped)]
    elif stripped.startswith("tolerance"):
        draft.tick_s = _tick(stripped.partition("=")[2].strip())
    elif stripped.startswith("bindings"):
        draft.part = "bindings"
    elif draft.part == "bindings":
        draft.bindings.append(line)
    elif draft.part == "orderings":
        draft.bounds.append(tuple(map(_bound, _row(stripped, draft))))
    else:
        _read_step(stripped, draft)


def _read_step(line: str, draft: _Draft) -> None:
    if match := _STEP.fullmatch(line):
        draft.consumer = _whole(match[1])
        if draft.consumer in draft.actions or draft.consumer == 0:
            raise ValueError(f"step {draft.consumer} is given twice")
        draft.actions[draft.consumer] = _fact(match[2])
    elif match := _LINK.fullmatch(line):
        if draft.consumer is None:
            raise ValueError("a causal link before any step")
        draft.links.append(Link(_whole(match[1]), _literal(match[2]), draft.consumer))
    elif match := _PLAIN.fullmatch(line):
        draft.decimals = max(draft.decimals, *(len((text or "").partition(".")[2]) for text in (match[1], match[3])))
        _enter(_fact(match[2]), _number(match[1]), match[3], draft)
    elif _FACT.fullmatch(line) and draft.consumer is None:
        _enter(_fact(line), len(draft.plain) + 1.0, None, draft)
    else:
        raise ValueError(f"expected a step, a causal link or a part's name, found '{line[:60]}'")


def _enter(action: Fact, start: float, duration: str | None, draft: _Draft) -> None:
    number = len(draft.plain) + 1
    if duration is None:
        draft.instant.add(number)
    draft.plain.append(Step(number, action, start, 1.0 if duration is None else _number(duration)))


def _row(text: str, draft: _Draft) -> list[str]:
    """The words of one more row of the table of orderings, as many as there may be."""
    words = text.split()
    if max(len(words), len(draft.bounds) + 1) > 2 * MAX_STEPS + 1:
        raise ValueError(f"a table of orderings for more than {MAX_STEPS} steps")
    return words


def _bound(text: str) -> int | None:
    return None if text == "inf" else _whole(text, MAX_BOUND_DIGITS)


def _whole(text: str, most: int = MAX_DIGITS) -> int:
    _check_length(text, most)
    if not _INTEGER.fullmatch(text):
        raise ValueError(f"expected a whole number, found '{text[:60]}'")
    return int(text)


def _number(text: str) -> float:
    _check_length(text)
    if not _DECIMAL.fullmatch(text) or not 0 <= float(text) < 10**MAX_DIGITS:
        raise ValueError(f"expected a time, found '{text[:60]}'")
    return float(text)


def _tick(text: str) -> float:
    tick_s = _number(text)
    if tick_s < NANOSECOND_S:
        raise ValueError(f"expected a tick of at least {NANOSECOND_S:g} s, found '{text}'")
    return tick_s


def _check_length(text: str, most: int = MAX_DIGITS) -> None:
    if len(text.partition(".")[0].lstrip("-")) > most:
        raise ValueError(f"a number of more than {most} digits: {text[:20]}...")


def _facts(text: str) -> list[Fact]:
    return [tuple(match.lower().split()) for match in _FACT.findall(text)]


def _fact(text: str) -> Fact:
    match = _FACT.fullmatch(text)
    if match is None:
        raise ValueError(f"expected (name argument ...), found '{text[:60]}'")
    return tuple(match[1].lower().split())


def _literal(text: str) -> Literal:
    negated = re.fullmatch(r"\(not\s+(\(.*\))\s*\)", text)
    return Literal(_fact(negated[1]), positive=False) if negated else Literal(_fact(text))


# --- the plain form ------------------------------------------------------------------------------
def _from_plain(draft: _Draft) -> Plan:
    """The plan; where some steps have a duration, those without take no time."""
    ordered = sorted(draft.plain, key=lambda step: step.start)  # a planner may print them in any order
    if len(draft.instant) == len(ordered):
        return Plan(draft.problem, (), tuple(ordered))
    steps = tuple(replace(step, duration=0.0) if step.id in draft.instant else step for step in ordered)
    tick_s = min(DEFAULT_TICK_S, 10.0 ** -min(draft.decimals, MAX_DIGITS))
    return Plan(draft.problem, (), steps, durative=True, tick_s=tick_s)


# --- the causal-link form ------------------------------------------------------------------------
def _from_links(draft: _Draft) -> Plan:
    declared = {0, GOAL, *draft.actions}
    for i, j in [*draft.orderings, *((link.producer, link.consumer) for link in draft.links)]:
        if i not in declared or j not in declared:
            raise PlanTextError(f"plan text: {i} and {j} are linked or ordered, but one of them is not a step")
    if not draft.bounds:
        starts = levels(tuple(draft.actions), draft.orderings)
        if starts is None:
            raise PlanTextError("plan text: the orderings have a cycle")
        steps = tuple(Step(number, action, starts[number]) for number, action in draft.actions.items())
        return _plan(draft, steps, tuple(draft.orderings))
    size = 2 * len(draft.actions) + 1
    if sorted(draft.actions) != list(range(1, len(draft.actions) + 1)) or {len(r) for r in draft.bounds} != {size}:
        raise PlanTextError(f"plan text: expected a {size} x {size} table of orderings")
    if len(draft.bounds) != size:
        raise PlanTextError(f"plan text: expected {size} rows of orderings, found {len(draft.bounds)}")
    return _durative(draft)


def _durative(draft: _Draft) -> Plan:
    tick_s = exact(draft.tick_s)
    _check_bounds(draft, 10**MAX_DIGITS * exact(DEFAULT_TICK_S) / tick_s)
    steps = []
    for number, action in draft.actions.items():
        start, end = draft.bounds[2 * number - 1][0], draft.bounds[2 * number][0]
        if start is None or end is None:
            raise PlanTextError(f"plan text: step {number} has no earliest time")
        steps.append(Step(number, action, float(-start * tick_s), float((start - end) * tick_s)))
    numbers = sorted(draft.actions)
    pairs = []
    for i in numbers:
        for j in numbers:
            bound = draft.bounds[2 * j - 1][2 * i]
            if i != j and bound is not None and bound <= 0:
                pairs.append((i, j))
    return _plan(draft, tuple(steps), tuple(pairs))


def _check_bounds(draft: _Draft, most: Fraction) -> None:
    for bound in (bound for row in draft.bounds for bound in row if bound is not None):
        if abs(bound) >= most:
            raise PlanTextError(f"plan text: a bound of too many digits for ticks of {draft.tick_s:g} s: {bound}")


def _plan(draft: _Draft, steps: tuple[Step, ...], orderings: tuple[tuple[int, int], ...]) -> Plan:
    return Plan(
        draft.problem,
        draft.initial,
        tuple(sorted(steps, key=lambda step: step.start)),
        tuple(draft.links),
        orderings,
        bool(draft.bounds),
        tuple(draft.bounds),
        draft.tick_s,
        bindings=tuple(draft.bindings),
    )
