"""The finished plan (steps by time, causal links, orderings) and the result of a search."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal as OneOf

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Literal

Status = OneOf["solved", "unsolvable", "limit", "unsupported"]


@dataclass(frozen=True, slots=True)
class Step:
    """A scheduled action: `start` counts levels from 1, or seconds from 0 in a durative plan."""

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


def by_consumer(links: Iterable[Link], steps: Iterable[Step]) -> tuple[Link, ...]:
    """Links in the order of their consumers, the goal's last; those of one consumer stay in theirs."""
    position = {step.id: n for n, step in enumerate(steps)}
    return tuple(sorted(links, key=lambda link: position.get(link.consumer, len(position))))


GOAL = -1  # consumer of the causal links that support the goal
DEFAULT_TICK_S = 0.01  # VHPOP's tolerance


@dataclass(frozen=True, slots=True)
class Plan:
    """A partial-order plan with a schedule.

    `steps` are sorted by start time; `links` by consumer in the order of the steps (the goal last), each consumer's
    newest first, links from static facts included. `orderings` are the pairs (i, j) of steps with i before j: without
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

    def action_of(self, step: int) -> Fact | None:
        """The ground action of the step with that id; None if there is none."""
        return next((each.action for each in self.steps if each.id == step), None)

    def links_to(self, consumer: int) -> tuple[Link, ...]:
        """The causal links that support a step, or the goal."""
        return tuple(link for link in self.links if link.consumer == consumer)


@dataclass(frozen=True, slots=True)
class Result:
    """Outcome of a search, with the numbers of plans generated and visited.

    `solved` comes with a plan, the others with a reason: `unsolvable` is proven, `limit` is a limit of plans, steps,
    time or memory, `unsupported` is a PDDL feature outside the planner's language.
    """

    status: Status
    plan: Plan | None
    reason: str
    generated: int
    visited: int
