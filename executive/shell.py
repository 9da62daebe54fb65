"""The live shell: waits for the deadline, drains the inbox, calls the core, publishes. Decides nothing itself."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from tailor.executive.core.context import PERIOD_NS, Context, check_goal
from tailor.executive.core.deliberation_cycle import pending_request
from tailor.executive.core.state import Inputs, Output, State, initial_state
from tailor.executive.core.step import control, deliberate
from tailor.runtime import realtime
from tailor.runtime.budget import ClockBudget
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import Clock
from tailor.runtime.loop import Loop, Period
from tailor.runtime.processes.external_planner import ExternalPlanner
from tailor.schemas.messages import PlanRequest, Provenance, Sample, TickReport

DELIBERATION_NS = 60_000_000  # of a tick's 100 ms
TICK_END_NS = 80_000_000  # the whole tick is done by then, however late it began
PROVENANCE_TICKS = 10  # once a second, so that a recorder that comes late gets it too
TOPICS = (
    "arm_request", "finished", "plan", "plan_request", "plan_answer", "subgoals", "refinement", "status", "tick",
    "provenance",
)  # fmt: skip


class Shell:
    """One executive on the bus."""

    def __init__(self, context: Context, session: Session, clock: Clock, provenance: Mapping[str, Any]) -> None:
        """Subscribe and declare; nothing is published before `run`."""
        domain = context.domain
        self._context = context
        self._clock = clock
        self._provenance = json.dumps(provenance, sort_keys=True)
        self._inbox = session.inbox((*domain.sensors, "driver"), domain.robot)
        self._goals = session.service_server("exec/goal")
        topics = (domain.command_topic, *TOPICS)
        self._publishers = {topic: session.publisher(topic, domain.robot) for topic in topics}
        external = context.settings.external
        self._planner = ExternalPlanner(external.command, external.limit_s)
        self._state = initial_state(context)

    def run(self, goal: str, until: Callable[[State], bool]) -> State:
        """Tick until `until` says so; the last tick brings the robot to rest.

        Args:
          goal: A checked PDDL goal for the first tick; empty: wait for one.
          until: Looked at before every tick.
        """
        loop = Loop(PERIOD_NS, self._clock)
        try:
            while True:
                turn = loop.wait_for_next_period()
                stopping = until(self._state)
                self._tick(turn, goal, stopping)
                goal = ""
                if stopping:
                    return self._state
                realtime.collect_young()
        finally:
            self._planner.close()

    def _tick(self, turn: Period, goal: str, stopping: bool) -> None:
        samples = (*self._inbox.drain(turn.now_ns), *self._planner_answer(turn))
        inputs = Inputs(samples, self._requested_goal() or goal, turn.skipped, stopping)
        self._state, outputs = control(self._context, self._state, turn.now_ns, inputs)
        self._publish(outputs)
        control_ns = self._clock.now_ns() - turn.now_ns
        deadline_ns = min(turn.now_ns + DELIBERATION_NS, turn.deadline_ns + TICK_END_NS)
        budget = ClockBudget(deadline_ns, self._clock.now_ns)
        self._state, outputs = deliberate(self._context, self._state, budget)
        self._publish(outputs)
        self._report(turn, inputs, control_ns, budget.granted)

    def _requested_goal(self) -> str:
        """An accepted goal of this tick's request, "" without one; an invalid goal is refused with its cause."""
        request = self._goals.poll()
        if request is None:
            return ""
        goal = request.text.strip() or self._context.problem.goal_text
        refusal = check_goal(self._context, goal)
        if refusal is not None:
            request.refuse(str(refusal))
            return ""
        request.accept()
        return goal

    def _planner_answer(self, turn: Period) -> tuple[Sample, ...]:
        """The external planner's answer as an input like any other: numbered, and recorded before it is used."""
        request, stamp_ns = pending_request(self._state), self._context.stamp(turn.now_ns)
        answer = self._planner.poll(request.id if request is not None else 0, stamp_ns)
        if answer is None:
            return ()
        publisher = self._publishers["plan_answer"]
        sequence = publisher.publish(answer)
        return (Sample(publisher.key, answer, turn.now_ns, sequence, self._context.sender),)

    def _publish(self, outputs: tuple[Output, ...]) -> None:
        for output in outputs:
            self._publishers[output.topic].publish(output.message)
            if isinstance(output.message, PlanRequest):
                self._planner.request(output.message)

    def _report(self, turn: Period, inputs: Inputs, control_ns: int, checks: int) -> None:
        tick = self._state.tick
        stamp_ns = self._context.stamp(turn.now_ns)
        if tick % PROVENANCE_TICKS == 1:
            self._publishers["provenance"].publish(Provenance(stamp_ns, self._provenance))
        work_ns = self._clock.now_ns() - turn.now_ns
        self._publishers["tick"].publish(tick_report(stamp_ns, tick, turn, inputs, (control_ns, work_ns, checks)))


def tick_report(stamp_ns: int, tick: int, turn: Period, inputs: Inputs, spent: tuple[int, int, int]) -> TickReport:
    """Timing of a tick and what it was given; `spent` is control time, work time (ns) and checks granted."""
    control_ns, work_ns, checks = spent
    samples: tuple[Sample, ...] = inputs.samples
    return TickReport(
        stamp_ns=stamp_ns,
        tick=tick,
        now_ns=turn.now_ns,
        lateness_ns=turn.lateness_ns,
        control_ns=control_ns,
        work_ns=work_ns,
        skipped=turn.skipped,
        checks_granted=checks,
        goal=inputs.goal,
        stopping=inputs.stopping,
        input_keys=tuple(s.key for s in samples),
        input_senders=tuple(s.sender for s in samples),
        input_sequences=tuple(s.sequence for s in samples),
        input_arrivals_ns=tuple(s.arrival_ns for s in samples),
    )
