"""Plans of up to 200 steps: no tick does more work than its checks grant, and no message grows with the plan."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from tailor.executive import planning
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation import plan_reuse, plan_source
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning.plans import portions
from tailor.executive.planning.semantics import links, regression, simulation, validator
from tailor.executive.refinement.instantiation import MAX_ACTIONS
from tailor.executive.replay import RecordedTick, replay
from tailor.schemas.codec import encode
from tailor.schemas.messages import PlanReport, Subgoals
from tailor.schemas.topics import TOPICS
from tailor.tools.benchmarks.execution.long_plans import PERIOD_NS, porter_context, samples
from tailor.tools.benchmarks.planning_scale import goal_text
from tests.replay.test_replay_core import FickleBudget

CUPS = 25  # 100 steps
MOST_PER_PORTION = 4  # links
FORWARD = Settings(planner=planning.Settings(engine="forward"), improve_plans=0)


class Run:
    """The porter for so many ticks; `published` are the outputs by tick."""

    def __init__(self, cups, budget_of, ticks, settings=FORWARD):
        self.context = porter_context(cups, settings)
        self.published, self.recorded, self.x_m = [], [], 0.0
        self.state = initial_state(self.context)
        for n in range(1, ticks + 1):
            given, budget = Inputs(samples(n * PERIOD_NS, n, self.x_m), goal_text(cups) if n == 1 else ""), budget_of(n)
            self.state, outputs = step(self.context, self.state, n * PERIOD_NS, given, budget)
            self.recorded.append(RecordedTick(n, n * PERIOD_NS, given, budget.granted))
            self.published.append((n, outputs))
            self.x_m += 0.1 * self.state.command[0]

    def messages(self, kind):
        return [(n, o.message) for n, outputs in self.published for o in outputs if isinstance(o.message, kind)]


class MeteredBudget(CheckBudget):
    """Notes how much work was done before each check."""

    def __init__(self, checks, work):
        super().__init__(checks)
        self.work, self.before_check = work, []

    def spent(self):
        self.before_check.append(self.work.total())
        self.work.clear()
        return super().spent()


@pytest.fixture
def work(monkeypatch):
    """Counts the steps of plans that are simulated, checked, regressed or ordered, by function."""
    counts = Counter()

    def counted(module, name):
        real = getattr(module, name)

        def spy(*arguments, **named):
            counts[name] += 1
            return real(*arguments, **named)

        monkeypatch.setattr(module, name, spy)

    counted(validator, "bind_step")
    counted(validator, "_check_interference")
    counted(simulation, "_effects")
    counted(regression.Regression, "add")
    counted(links, "Link")
    return counts


def test_no_more_steps_are_treated_before_a_check_than_it_grants(work, monkeypatch):
    def budget_of(tick):
        work.clear()
        budgets.append(MeteredBudget(10_000 if tick == 1 else 9, work))
        return budgets[-1]

    monkeypatch.setattr(portions, "PORTIONS", 8)
    monkeypatch.setattr(plan_source, "REUSE_FREE_PORTIONS", 8)
    monkeypatch.setattr(plan_reuse, "REUSE_FREE_PORTIONS", 8)
    budgets = []
    run = Run(CUPS, budget_of, ticks=120)
    assert len(run.messages(PlanReport)) > 5, "the search, and the suffix after each of some actions"
    before_checks = [n for budget in budgets[1:] for n in budget.before_check]
    assert max(before_checks) <= MOST_PER_PORTION * (8 + 8)
    assert sum(before_checks) > 50 * max(before_checks), "else this test has seen no long work"


def test_the_suffix_takes_several_starved_ticks_and_is_the_same_as_in_one():
    def plans(checks):
        return [
            m.plan for _, m in Run(CUPS, lambda n: CheckBudget(10**6 if n == 1 else checks), 60).messages(PlanReport)
        ]

    starved, rich = plans(2), plans(10**6)
    assert len(starved) > 2
    assert starved == rich[: len(starved)]


def test_the_suffix_is_prepared_while_the_action_runs():
    run = Run(CUPS, lambda n: CheckBudget(10**6 if n == 1 else 200), 40)
    ends = [n for n, outputs in run.published for o in outputs if o.topic == "finished"]
    plans = [n for n, _ in run.messages(PlanReport)]
    assert len(ends) > 5
    assert plans[1 : len(ends) + 1] == ends, "the rest of the plan is there in the tick in which the action ends"


@pytest.mark.parametrize("seed", range(3))
def test_a_run_of_a_long_plan_is_replayed_bit_for_bit(seed):
    rng = np.random.default_rng(seed)
    run = Run(CUPS, lambda n: CheckBudget(10**6) if n == 1 else FickleBudget(rng), 60)
    assert len(run.messages(PlanReport)) > 2
    assert list(replay(porter_context(CUPS, FORWARD), run.recorded)) == run.published


def test_messages_of_a_plan_of_200_steps_are_bounded():
    run = Run(50, lambda n: CheckBudget(10**6), 2)
    ((_, report),) = run.messages(PlanReport)[:1]
    assert len(encode(report)) < 20_000 < TOPICS["plan"].max_bytes
    assert planning.number_of_steps(report.plan) == 200
    assert len(planning.parse_plan(report.plan).steps) == planning.EXCERPT_STEPS
    ((_, subgoals),) = run.messages(Subgoals)[:1]
    assert len(subgoals.actions) == MAX_ACTIONS
    assert len(encode(subgoals)) < TOPICS["subgoals"].max_bytes
