"""External planner at the core: requested with the current facts, validated, never waited for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.executive.core.deliberation_cycle import pending_request
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PlannerCommand, Settings
from tailor.executive.deliberation.plan_source import GRACE_S
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.reasons import Reason
from tailor.executive.planning import format_links, format_plan, parse_domain, parse_plan, parse_problem, validate
from tailor.executive.replay import RecordedTick, replay
from tailor.schemas.messages import ActionFinished, PlanAnswer, PlanReport, PlanRequest, Sample
from tests.replay.test_replay_core import FickleBudget
from tests.support.planning.planning_problems import solve
from tests.support.toy_domain import SENDER, inputs, line_context

TICK = 100_000_000
GOAL = "(and (visited a) (visited b) (at b))"
LIMIT_S = 1.5
WITH_PLANNER = Settings(external=PlannerCommand("vhpop", LIMIT_S))


def well(request):
    """Output of a correct planner."""
    domain = parse_domain(request.domain)
    return format_links(solve(domain, parse_problem(request.problem, domain)).plan)


def plainly(request):
    domain = parse_domain(request.domain)
    return format_plan(solve(domain, parse_problem(request.problem, domain)).plan)


def unsoundly(request):
    return ";p\nInitial :\nStep 1 : (slide a b)\nGoal :\norderings = { }\n"


def answer_of(request, prints, outcome="answered"):
    output = prints(request) if outcome == "answered" else ""
    return PlanAnswer(0, request.id, outcome, output, f"the planner {outcome}")


class Run:
    """The robot on a line with a planner that answers each request after some ticks, or never (None)."""

    def __init__(self, answer, delay=3, context=None, budget=lambda: CheckBudget(200)):
        self.context = context or line_context(WITH_PLANNER)
        self.state, self.x, self.tick = initial_state(self.context), 0.0, 0
        self.answer, self.delay, self.budget = answer, delay, budget
        self.published, self.recorded = [], []
        self.due = {}

    def go(self, ticks=100, goals=((1, GOAL),)):
        goals = dict(goals)
        for _ in range(ticks):
            self.tick += 1
            n = self.tick
            given = inputs(n * TICK, self.x, goals.get(n, ""))
            for message in self.due.pop(n, ()):
                sample = Sample("exec/plan_answer", message, n * TICK, n, SENDER)
                given = replace(given, samples=(*given.samples, sample))
            budget = self.budget()
            self.state, outputs = step(self.context, self.state, n * TICK, given, budget)
            self.recorded.append(RecordedTick(n, n * TICK, given, budget.granted))
            self.published.append((n, outputs))
            self.x += 0.1 * self.state.command[0]
            for output in outputs:
                if isinstance(output.message, PlanRequest) and self.answer is not None:
                    self.due.setdefault(n + self.delay, []).append(self.answer(output.message))
        return self

    def messages(self, kind):
        return [(n, o.message) for n, outputs in self.published for o in outputs if isinstance(o.message, kind)]


@pytest.mark.parametrize("prints", [well, plainly])
def test_a_good_answer_is_executed_with_all_its_links(prints):
    run = Run(lambda request: answer_of(request, prints)).go()
    assert run.state.task.result == "achieved"
    reports = [report for _, report in run.messages(PlanReport)]
    assert [(r.status, r.way) for r in reports][:2] == [("solved", "external"), ("solved", "suffix")]
    links = {(link.producer, link.literal.fact) for link in parse_plan(reports[0].plan).links}
    assert (0, ("place", "a")) in links, "links from static facts, which the planner may leave out"


def test_the_request_is_pddl_of_the_facts_of_now_and_is_made_once():
    run = Run(None).go(ticks=10)
    ((tick, request),) = run.messages(PlanRequest)
    assert tick == 1
    domain = parse_domain(request.domain)
    problem = parse_problem(request.problem, domain)
    assert set(problem.initial) == {("at", "home"), ("place", "a"), ("place", "b")}
    assert validate(parse_plan(well(request)), domain, problem) == ""
    assert pending_request(run.state) is request


def test_nothing_moves_while_a_request_is_pending_and_no_check_is_spent():
    run = Run(None).go(ticks=10)
    assert run.state.command == (0.0,)
    assert [tick.checks for tick in run.recorded] == [0] * 10


@pytest.mark.parametrize(
    ("answer", "reason", "detail"),
    [
        (lambda r: answer_of(r, well, "timeout"), Reason.PLANNER_FAILED, "timeout: the planner timeout"),
        (lambda r: answer_of(r, well, "flood"), Reason.PLANNER_FAILED, "flood"),
        (lambda r: answer_of(r, well, "crashed"), Reason.PLANNER_FAILED, "crashed"),
        (lambda r: answer_of(r, well, "missing"), Reason.PLANNER_FAILED, "missing"),
        (lambda r: answer_of(r, lambda _: ""), Reason.PLAN_UNREADABLE, "there is no plan"),
        (lambda r: answer_of(r, lambda _: "\0\ufffd(((" * 99), Reason.PLAN_UNREADABLE, "plan text, line 1"),
        (lambda r: answer_of(r, unsoundly), Reason.PLAN_UNSOUND, ""),
    ],
)
def test_a_failed_planner_is_reported_once_and_the_built_in_search_takes_over(answer, reason, detail):
    run = Run(answer).go()
    reports = [report for _, report in run.messages(PlanReport)]
    assert (reports[0].status, reports[0].way, reports[0].plan) == ("failed", "external", "")
    assert reports[0].reason == reason
    assert detail in reports[0].detail
    assert reports[0].detail
    assert (reports[1].status, reports[1].way) == ("solved", "searched")
    assert sum(report.status == "failed" for report in reports) == 1
    assert run.state.task.result == "achieved"


def test_after_a_failure_it_gets_a_request_only_for_a_new_goal():
    places = {"home": {"x": 0.0}, "a": {"x": 95.0}, "b": {"x": 1.0}}  # a is too far: the action fails, twice
    run = Run(lambda r: answer_of(r, well, "crashed"), context=line_context(WITH_PLANNER, places))
    run.go(ticks=20, goals=[(1, "(visited a)")])
    assert len([r for _, r in run.messages(PlanReport) if r.way == "searched"]) > 1, "it planned again"
    assert len(run.messages(PlanRequest)) == 1
    run.go(ticks=5, goals=[(21, "(visited b)")])
    assert [tick for tick, _ in run.messages(PlanRequest)] == [1, 21]


def test_a_fault_starts_no_planner():
    """In the tick of the fault another request was made; the planner ran while nobody waited for its plan."""
    places = {"home": {"x": 0.0}, "a": {"x": 95.0}, "b": {"x": 1.0}}  # a is too far: the action fails, twice
    run = Run(lambda r: answer_of(r, well), 1, line_context(WITH_PLANNER, places)).go(20, [(1, "(visited a)")])
    assert run.state.mode is Mode.FAULT
    assert len(run.messages(PlanRequest)) == len(run.messages(ActionFinished)) == 2
    assert pending_request(run.state) is None


def test_an_answer_that_never_comes_does_not_hold_the_robot_for_ever():
    run = Run(None).go(ticks=120)
    (failed,) = [(n, r) for n, r in run.messages(PlanReport) if r.status == "failed"]
    assert "no answer within 3.5 s" in failed[1].detail
    assert failed[0] == pytest.approx(1 + 10 * (LIMIT_S + GRACE_S), abs=1)
    assert run.state.task.result == "achieved"


def test_an_answer_to_another_request_is_ignored():
    run = Run(lambda r: replace(answer_of(r, well), id=r.id + 1)).go(ticks=10)
    assert run.messages(PlanReport) == []
    assert pending_request(run.state) is not None


def test_a_new_goal_drops_the_request_and_makes_another():
    run = Run(lambda r: answer_of(r, well), delay=5).go(ticks=60, goals=[(1, "(visited a)"), (3, "(visited b)")])
    assert [tick for tick, _ in run.messages(PlanRequest)] == [1, 3]
    first = run.messages(PlanReport)[0]
    assert (first[0], first[1].way) == (8, "external"), "the answer to the first request came in tick 6"
    assert run.x == pytest.approx(1.0, abs=0.06)


def test_without_a_command_there_is_no_request():
    run = Run(None, context=line_context()).go(ticks=5)
    assert run.messages(PlanRequest) == []
    assert run.messages(PlanReport)[0][1].way == "searched"


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("outcome", ["answered", "flood"])
def test_a_run_with_recorded_answers_is_replayed_bit_for_bit(seed, outcome):
    rng = np.random.default_rng(seed)
    run = Run(lambda r: answer_of(r, well, outcome), delay=seed + 1, budget=lambda: FickleBudget(rng)).go(ticks=60)
    assert any(report.way == "external" for _, report in run.messages(PlanReport))
    assert list(replay(line_context(WITH_PLANNER), run.recorded)) == run.published


def test_a_replay_without_the_recorded_answer_is_noticed():
    run = Run(lambda r: answer_of(r, well)).go(ticks=30)
    deaf = [
        replace(t, inputs=replace(t.inputs, samples=tuple(s for s in t.inputs.samples if s.key != "exec/plan_answer")))
        for t in run.recorded
    ]
    assert list(replay(line_context(WITH_PLANNER), deaf)) != run.published


def with_head_start(plans):
    return line_context(Settings(external=PlannerCommand("kairos", LIMIT_S, after_plans=plans)))


def test_a_search_that_ends_within_its_head_start_makes_the_request_needless():
    run = Run(lambda r: answer_of(r, well), context=with_head_start(10_000)).go()
    assert run.messages(PlanRequest) == []
    assert run.messages(PlanReport)[0][1].way == "searched"


@pytest.mark.parametrize(("outcome", "ways"), [("answered", ["external"]), ("crashed", ["external", "searched"])])
def test_after_the_head_start_the_planner_is_asked_and_the_search_goes_on_if_that_fails(outcome, ways):
    run = Run(lambda r: answer_of(r, well, outcome), context=with_head_start(2)).go()
    assert len(run.messages(PlanRequest)) == 1
    assert [report.way for _, report in run.messages(PlanReport)][: len(ways)] == ways
    assert run.state.task.result == "achieved"


def test_the_time_limit_of_the_planner_counts_from_its_request_and_not_from_its_head_start():
    """A planner that was requested later than its limit, e.g. since the robot was held, was killed in the next tick."""
    begun = round(10 * (LIMIT_S + GRACE_S)) + 5
    scarce = iter([0] * (begun - 1))
    run = Run(lambda r: answer_of(r, well), 5, with_head_start(2), lambda: CheckBudget(next(scarce, 200)))
    run.go(ticks=begun + 60)
    ((tick, request),) = run.messages(PlanRequest)
    assert (tick, request.stamp_ns) == (begun, begun * TICK)
    assert run.messages(PlanReport)[0][1].way == "external"
    assert run.messages(PlanReport)[0][1].status == "solved"


@pytest.mark.parametrize("seed", range(3))
def test_a_run_with_a_head_start_is_replayed_bit_for_bit(seed):
    rng = np.random.default_rng(seed)
    run = Run(lambda r: answer_of(r, well), context=with_head_start(2), budget=lambda: FickleBudget(rng)).go(ticks=60)
    assert any(report.way == "external" for _, report in run.messages(PlanReport))
    assert list(replay(with_head_start(2), run.recorded)) == run.published


def test_what_is_proven_unsolvable_needs_no_request():
    run = Run(lambda r: answer_of(r, well), context=with_head_start(10_000))
    run.go(ticks=5, goals=((1, "(and (at a) (at b) (not (place a)))"),))
    assert run.messages(PlanRequest) == []
    assert run.messages(PlanReport)[0][1].status == "unsolvable"
