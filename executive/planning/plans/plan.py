"""The plan that the planner hands over: steps by time, causal links, orderings. And the result that carries it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Literal

Status = OneOf["solved", "unsolvable", "limit", "unsupported"]


@dataclass(frozen=True, slots=True)
class Step:
    """An action at its place: `start` counts levels from 1, or seconds from 0 in a durative plan."""

    id: int
    action: Fact
    start: float
    duration: float = 1.0


@dataclass(frozen=True, slots=True)
class Link:
    """A causal link: step `producer` (0: the initial state) makes `literal` true for `consumer` (GOAL: the goal)."""

    producer: int
    literal: Literal
    consumer: int


GOAL = -1  # consumer of the causal links that support the goal
DEFAULT_TICK_S = 0.01  # VHPOP's tolerance


@dataclass(frozen=True, slots=True)
class Plan:
    """A partial-order plan with a schedule.

    `steps` stand by start time, `links` by consumer in the order of the steps (the goal last), each consumer's newest
    first, links to static facts included. `orderings` are the pairs (i, j) of steps with i before j: without
    durations all of them, with durations those where i ends before j starts. `bounds` is the temporal network of a
    durative plan: [a][b] is the greatest t_b - t_a in ticks of `tick_s` (None: unbounded) over the initial state and
    then start and end of steps 1, 2, ...; `bindings` are the lines that VHPOP adds to a lifted plan.
    """

    problem: str
    initial: tuple[Fact, ...]
    steps: tuple[Step, ...]
    links: tuple[Link, ...] = ()
    orderings: tuple[tuple[int, int], ...] = ()
    durative: bool = False
    bounds: tuple[tuple[int | None, ...], ...] = ()
    tick_s: float = DEFAULT_TICK_S
    bindings: tuple[str, ...] = ()

    @property
    def makespan(self) -> float:
        """The last step's end in seconds; without durations the number of levels."""
        if not self.durative:
            return max((step.start for step in self.steps), default=0.0)
        return max((step.start + step.duration for step in self.steps), default=0.0)

    def links_to(self, consumer: int) -> tuple[Link, ...]:
        """The causal links that support a step, or the goal."""
        return tuple(link for link in self.links if link.consumer == consumer)


@dataclass(frozen=True, slots=True)
class Result:
    """How a search ended: a plan, a proof that there is none, a limit, or a feature that the planner does not speak."""

    status: Status
    plan: Plan | None
    reason: str
    generated: int
    visited: int


def unreachable() -> Result:
    """The proof without a search: the relaxed planning graph never reaches the goal."""
    return Result("unsolvable", None, "the goal cannot be reached, not even without delete effects", 1, 0)


def dead_end(too_long: bool, step_limit: int, generated: int, visited: int) -> Result:
    """The search ran dry: a proof, unless plans were left out for their length."""
    if too_long:
        return Result("limit", None, f"no plan of up to {step_limit} steps", generated, visited)
    return Result("unsolvable", None, "every partial plan has been refined to a dead end", generated, visited)
