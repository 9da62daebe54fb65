"""What the executive carries from tick to tick, what comes in, and what goes out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tailor.executive.core.command_guard import at_rest
from tailor.executive.core.context import Context
from tailor.executive.core.deliberation import Decision, Deliberation
from tailor.executive.core.execution import Running
from tailor.executive.core.improvement import Improvement
from tailor.executive.core.modes import Mode
from tailor.executive.interfaces.values import Belief, Fact
from tailor.executive.planning import GroundCache, Plan
from tailor.schemas.messages import DriverState, Message, Sample


@dataclass(frozen=True, slots=True)
class Inputs:
    """All that reached the executive since the last tick: newest sample a topic, oldest arrival first."""

    samples: tuple[Sample, ...] = ()
    goal: str = ""  # a PDDL goal that was accepted by `check_goal`
    skipped: int = 0  # whole periods lost before this tick
    stopping: bool = False  # the last tick: come to rest and let the driver go


@dataclass(frozen=True, slots=True)
class Output:
    """One message to publish under the name of a topic in tailor.schemas.topics."""

    topic: str
    message: Message


@dataclass(frozen=True, slots=True)
class Arming:
    """Whom the driver obeys, and which of its epochs was asked to arm: once each, for restart is not resume."""

    driver: DriverState | None = None
    asked_epoch: int = 0
    asked_ns: int = 0


@dataclass(frozen=True, slots=True)
class Task:
    """The goal and how far it has come."""

    goal: str = ""
    active: bool = False
    result: str = ""  # "", "achieved", "failed: why"
    facts: frozenset[Fact] = frozenset()  # the abstract state as remembered
    plan: Plan | None = None
    done: frozenset[int] = frozenset()  # steps of `plan` that have been executed
    finished: int = 0  # actions ended since the goal was set
    failures: tuple[str, ...] = ()  # what failed since the last success
    running: Running | None = None
    decision: Decision | None = None  # what the last deliberation chose
    external_failed: bool = False  # the external planner is not asked again for this goal


@dataclass(frozen=True, slots=True)
class State:
    """The executive between two ticks.

    `deliberation` and `improvement` are resumable and `ground` is a cache: they change in place, so a state is used
    for one step only.
    """

    belief: Belief
    command: tuple[float, ...]  # as sent last
    tick: int = 0
    now_ns: int = 0
    mode: Mode = Mode.DISARMED
    reason: str = ""
    fault: str = ""
    arrivals: Mapping[str, int] = field(default_factory=dict)
    overruns_ns: tuple[int, ...] = ()  # when whole periods were lost, during the last second
    arming: Arming = field(default_factory=Arming)
    task: Task = field(default_factory=Task)
    coasted: int = 0  # ticks since the last action ended
    deliberation: Deliberation | None = None
    improvement: Improvement | None = None
    ground: GroundCache = field(default_factory=GroundCache)
    deliberations: int = 0  # started so far; seeds their random generators


def initial_state(context: Context) -> State:
    """The executive before its first tick: no goal, no belief, a zero command."""
    return State(belief=context.domain.initial_belief(), command=at_rest(context.domain.axes))
