"""The live shell: waits for the period, drains the inbox, calls the core, publishes. Contains no decisions."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Mapping
from typing import Any

from tailor.executive.core.deliberation_cycle import pending_request
from tailor.executive.core.state import Inputs, Output, State, initial_state
from tailor.executive.core.step import at_once_at_rest, control, deliberate
from tailor.executive.deliberation.context import PERIOD_NS, Context, check_goal, drops_goal
from tailor.executive.interfaces.outlet import outlets_of
from tailor.executive.late_goals import LateGoals
from tailor.executive.repeated_goals import RepeatedGoals, is_pursued
from tailor.runtime import realtime
from tailor.runtime.budget import ClockBudget
from tailor.runtime.bus.ros_action.server import GoalAction
from tailor.runtime.bus.service import ServiceRequest
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import Clock
from tailor.runtime.loop import Loop, Period
from tailor.runtime.processes.external_planner import ExternalPlanner
from tailor.runtime.processes.notify import SILENT, Notifier
from tailor.schemas.messages import ExecStatus, PlanRequest, Provenance, Sample, TickReport
from tailor.schemas.topics import reports

DELIBERATION_NS = 60_000_000  # of a tick's 100 ms
TICK_END_NS = 80_000_000  # the whole tick is done by then, however late it began
PROVENANCE_TICKS = 10  # once a second, also for a recorder that starts late
ENDS = "the executive ends"


class Shell:
    """One executive on the bus."""

    def __init__(
        self,
        context: Context,
        session: Session,
        clock: Clock,
        provenance: Mapping[str, Any],
        notifier: Notifier = SILENT,
    ) -> None:
        """Create subscribers and publishers; nothing is published before `run`.

        Args:
          context: Configuration of the run; its sender is the session's.
          session: Session on the bus.
          clock: Monotonic clock.
          provenance: Published once a second, so that the run can be repeated.
          notifier: Receives that the executive is ready, and a report of every tick.
        """
        domain = context.domain
        self._context = context
        self._clock = clock
        self._notifier = notifier
        self._provenance = json.dumps(provenance, sort_keys=True)
        self._inbox = session.inbox((*domain.sensors, "driver"), domain.robot)
        self._action = GoalAction(session)
        self._goals = session.service_server("exec/goal", self._action)
        topics = (*(outlet.topic for outlet in outlets_of(domain)), "self_arm", *reports())
        self._publishers = {topic: session.publisher(topic, domain.robot) for topic in topics}
        external = context.settings.external
        self._planner = ExternalPlanner(external.command, external.limit_s)
        self._state = initial_state(context)
        self._late, self._repeated = LateGoals(), RepeatedGoals()

    @property
    def refused_fields(self) -> str:
        """Fields for which inputs were refused so far, by key, for people; another thread may read it."""
        return "; ".join(f"{key} refused: {text}" for key, text in sorted(self._inbox.refused_fields.copy().items()))

    @property
    def state(self) -> State:
        """The state after the newest tick; another thread may read it, but not step it."""
        return self._state

    def run(self, goal: str, until: Callable[[State], bool]) -> State:
        """Run ticks until `until` is True; the last tick brings the robot to rest.

        Args:
          goal: A goal that `check_goal` accepts, for the first tick; empty: wait for a request.
          until: Called before every tick with the state.

        Returns:
          The state after the last tick.
        """
        loop = Loop(PERIOD_NS, self._clock)
        self._notifier.ready()
        try:
            while True:
                period = loop.wait_for_next_period()
                stopping = until(self._state)
                self._tick_or_rest(period, goal, stopping)
                goal = ""
                self._notifier.alive()
                if stopping:
                    self._notifier.stopping()
                    return self._state
                realtime.collect_garbage(self._state.tick)
        finally:
            self._planner.close()
            self._action.close()

    def _tick_or_rest(self, period: Period, goal: str, stopping: bool) -> None:
        """One tick. If it raises, the robot brakes at once; the guard latches its stop, as no command follows."""
        try:
            self._tick(period, goal, stopping)
        except (Exception, SystemExit):
            with contextlib.suppress(Exception, SystemExit):  # code of the robot's package as well
                self._publish(at_once_at_rest(self._context, self._state, period.now_ns))
            raise

    def _tick(self, period: Period, goal: str, stopping: bool) -> None:
        received = self._inbox.drain(period.now_ns)
        samples = (*received, *self._planner_answer(period))
        inputs = Inputs(samples, self._goal(goal, period, received, stopping), period.skipped, stopping)
        self._state, outputs = control(self._context, self._state, period.now_ns, inputs)
        self._publish(outputs)
        control_ns = self._clock.now_ns() - period.now_ns
        deadline_ns = min(period.now_ns + DELIBERATION_NS, period.deadline_ns + TICK_END_NS)
        budget = ClockBudget(deadline_ns, self._clock.now_ns)
        self._state, outputs = deliberate(self._context, self._state, budget)
        self._publish(outputs)
        self._report(period, inputs, control_ns, budget.granted)

    def _goal(self, first: str, period: Period, received: tuple[Sample, ...], stopping: bool) -> str:
        """The goal that this tick's request sets, else `first`; an invalid goal is refused with its cause.

        So is one that may have waited while this process or the bus stood still: people were told that nobody responds.
        So is one that comes as the executive ends.
        One that only drops the open goal moves nothing, so it counts; the open goal, sent again, changes nothing.
        """
        request = self._goals.poll()
        late = ENDS if stopping else self._late_goals(period, received, request)
        if request is None:
            return first
        goal = request.text.strip() or self._context.problem.goal_text
        refusal = check_goal(self._context, goal)
        if refusal is not None:
            request.refuse(str(refusal))
            return first
        if not drops_goal(self._context, goal):
            if refused := late or self._repeated.refusal(goal, self._clock.now_ns(), self._state):
                request.refuse(refused)
                return first
            request.accept()
            return first if is_pursued(goal, self._state) else goal
        task = self._state.task
        dropped = first or (task.goal if task.active else "")
        request.accept(f"cancelled: {dropped}" if dropped else "no goal is open")
        return goal if dropped else ""

    def _late_goals(self, period: Period, received: tuple[Sample, ...], request: ServiceRequest | None) -> str:
        """Why this request is too old; called in every tick, after the look at goals.

        Of many that have waited, the last one is served seconds later: the time at which it was taken counts.
        """
        now_ns = self._clock.now_ns()
        stood_ns = max(now_ns - period.deadline_ns, period.skipped * PERIOD_NS)
        self._late.note(now_ns, stood_ns, max((sample.arrival_ns for sample in received), default=None))
        taken_ns = None if request is None else request.taken_ns
        return self._late.refusal(now_ns if taken_ns is None else taken_ns)

    def _planner_answer(self, period: Period) -> tuple[Sample, ...]:
        """The external planner's answer as an input like any other: numbered, and recorded before it is used."""
        request, stamp_ns = pending_request(self._state), self._context.stamp(period.now_ns)
        answer = self._planner.poll(request.id if request is not None else 0, stamp_ns)
        if answer is None:
            return ()
        publisher = self._publishers["plan_answer"]
        sequence = publisher.publish(answer)
        return (Sample(publisher.key, answer, period.now_ns, sequence, self._context.sender),)

    def _publish(self, outputs: tuple[Output, ...]) -> None:
        for output in outputs:
            self._publishers[output.topic].publish(output.message)
            if isinstance(output.message, PlanRequest):
                self._planner.request(output.message)
            if isinstance(output.message, ExecStatus):
                self._action.report(output.message)

    def _report(self, period: Period, inputs: Inputs, control_ns: int, checks: int) -> None:
        tick = self._state.tick
        stamp_ns = self._context.stamp(period.now_ns)
        if tick % PROVENANCE_TICKS == 1:
            self._publishers["provenance"].publish(Provenance(stamp_ns, self._provenance))
        work_ns = self._clock.now_ns() - period.now_ns
        self._publishers["tick"].publish(tick_report(stamp_ns, tick, period, inputs, (control_ns, work_ns, checks)))


def tick_report(stamp_ns: int, tick: int, period: Period, inputs: Inputs, spent: tuple[int, int, int]) -> TickReport:
    """Timing and inputs of a tick; `spent` is control time and work time (ns), and the number of granted checks."""
    control_ns, work_ns, checks = spent
    samples: tuple[Sample, ...] = inputs.samples
    return TickReport(
        stamp_ns=stamp_ns,
        tick=tick,
        now_ns=period.now_ns,
        lateness_ns=period.lateness_ns,
        control_ns=control_ns,
        work_ns=work_ns,
        skipped=period.skipped,
        checks_granted=checks,
        goal=inputs.goal,
        stopping=inputs.stopping,
        input_keys=tuple(s.key for s in samples),
        input_senders=tuple(s.sender for s in samples),
        input_sequences=tuple(s.sequence for s in samples),
        input_arrivals_ns=tuple(s.arrival_ns for s in samples),
    )
