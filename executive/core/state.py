"""State of the executive between ticks, inputs and outputs of a tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from tailor.executive.core.execution import Running
from tailor.executive.core.modes import Mode
from tailor.executive.core.sensing.measurements import Measurements, Speeds, fastest_of
from tailor.executive.core.sensing.streams import Stream
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision, Deliberation
from tailor.executive.deliberation.next_choice import NextChoice
from tailor.executive.deliberation.plan_reuse import Preparation
from tailor.executive.interfaces.domain_results import first_belief
from tailor.executive.interfaces.outlet import at_rest
from tailor.executive.interfaces.reasons import Cause, Result
from tailor.executive.interfaces.values import Belief, Fact
from tailor.executive.planning import GroundCache, Literal, Plan
from tailor.schemas.messages import DriverState, Message, Sample
from tailor.schemas.reason_text import reason_text


@dataclass(frozen=True, slots=True)
class Inputs:
    """Inputs of one tick: the newest sample of each topic, oldest arrival first."""

    samples: tuple[Sample, ...] = ()
    goal: str = ""  # a PDDL goal that was accepted by `check_goal`
    skipped: int = 0  # whole periods lost before this tick
    stopping: bool = False  # the last tick: come to rest and disarm the driver


@dataclass(frozen=True, slots=True)
class Output:
    """One message to publish under the name of a topic in tailor.schemas.topics."""

    topic: str
    message: Message


@dataclass(frozen=True, slots=True)
class Arming:
    """Last state of the driver, and the last request to arm. One epoch is armed: restart is not resume."""

    driver: DriverState | None = None
    driver_sender: str = ""  # of that state; "" before the first one: the first sender counts
    heard_ns: int | None = None  # arrival of that state; before the first one: the first tick
    echo_age_ns: int = 0  # age of the newest command that it echoes, at its arrival; 0: none
    rearmed: bool = False  # since the last tick: it was disarmed and armed again, while this process stood still
    requested_epoch: int = 0  # 0: no request yet
    requested_ns: int = 0
    requests: int = 0  # so far


@dataclass(frozen=True, slots=True)
class Task:
    """The goal and its progress."""

    goal: str = ""
    active: bool = False
    result: Result = Result.OPEN
    result_cause: Cause | None = None  # of a failed task
    facts: frozenset[Fact] = frozenset()  # the remembered abstract state
    left: frozenset[Fact] = frozenset()  # of these, what actions that began and were not done take away
    without_left: bool = False  # whether the goal is planned for without them: it holds by them alone
    plan: Plan | None = None
    done: frozenset[int] = frozenset()  # steps of `plan` that have been executed
    finished: int = 0  # actions ended since the goal was set
    failures: tuple[tuple[str, Cause], ...] = ()  # action and cause, since a step of the plan succeeded
    fruitless: tuple[tuple[Fact, Cause], ...] = ()  # failures of ground actions of the plan, since each was done
    lost: tuple[Literal, ...] = ()  # for want of which plans were given up since the goal was set
    unconfirmed: tuple[Fact, ...] = ()  # ground actions done without observed effects, since each was with them
    approached: tuple[Fact, ...] = ()  # ground actions whose asserted subgoals were reached, since each was done
    running: Running | None = None
    decision: Decision | None = None  # of the last deliberation
    external_failed: bool = False  # the external planner gets no more requests for this goal
    doubted_until_ns: int = 0  # by then the task fails if no way is found; 0: there was one

    @property
    def result_text(self) -> str:
        """The result for people, e.g. "achieved" or "failed: unsolvable: dead end"; "" while it is open."""
        return reason_text(self.result, str(self.result_cause) if self.result_cause is not None else "")


@dataclass(frozen=True, slots=True)
class Halt:
    """An action that was given up: until that time the robot brakes, and nothing is decided."""

    until_ns: int
    cause: Cause


@dataclass(frozen=True, slots=True)
class State:
    """The executive between two ticks.

    A step consumes it: `deliberation`, `preparation` and `next_choice` are resumed in place, and the cache `ground`
    grows. Each state is used for one step only.
    """

    belief: Belief
    command: tuple[float, ...]  # the last published one
    tick: int = 0
    now_ns: int = 0
    mode: Mode = Mode.DISARMED
    cause: Cause | None = None  # of the mode
    fault: Cause | None = None
    arrivals: Mapping[str, int] = field(default_factory=dict)
    streams: Mapping[str, Stream] = field(default_factory=dict)  # of the sensors, to know their rates
    measurements: Measurements = field(default_factory=Measurements)
    doubted: Mapping[str, int] = field(default_factory=dict)  # readings in a row that contradict the belief, by key
    fastest: Speeds | None = None  # that odometry may have, by the domain's axes; never changes
    overruns_ns: tuple[int, ...] = ()  # ticks of the last second before which whole periods were lost
    arming: Arming = field(default_factory=Arming)
    task: Task = field(default_factory=Task)
    coasted: int = 0  # ticks since the last action ended
    deliberation: Deliberation | None = None
    preparation: Preparation | None = None
    next_choice: NextChoice | None = None  # of the last decision that took several ticks
    ground: GroundCache = field(default_factory=GroundCache)
    carried: bool = False  # in this tick the belief found that the robot was moved by others
    halt: Halt | None = None  # the last one
    deliberations: int = 0  # number of started ones; seeds their random generators

    @property
    def halting(self) -> Halt | None:
        """The halt in which the robot brakes now; None if it does not."""
        return self.halt if self.halt is not None and self.now_ns < self.halt.until_ns else None


def undecided(state: State) -> State:
    """The state with its goal only: what comes next is planned and decided from where the robot stands then."""
    finished = state.task.finished + (state.task.running is not None)
    task = replace(state.task, running=None, decision=None, plan=None, finished=finished, doubted_until_ns=0)
    return replace(state, task=task, deliberation=None, preparation=None, next_choice=None)


def initial_state(context: Context) -> State:
    """State before the first tick: no goal, no percepts, a zero command."""
    domain, arming = context.domain, Arming(driver_sender=context.driver_sender)
    return State(first_belief(domain), at_rest(domain.axes), arming=arming, fastest=fastest_of(domain))
