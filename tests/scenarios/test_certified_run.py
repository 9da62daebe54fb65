"""Left-over budget of a run proves optimality gaps of its subgoals; a replay proves the same gaps."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.executive.deliberation.context import Settings
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.replay import replay
from tailor.schemas.messages import RefinementReport, Subgoals
from tailor.tools.lockstep.run import SENDER, run_lockstep
from tailor.tools.lockstep.worlds import make_world


def messages_of(outputs, kind):
    return [output.message for tick in outputs for output in tick if isinstance(output.message, kind)]


def run(certify_checks: int, checks: int = 12):
    """The begin of a run past waypoints: context, ticks as given, and what the core answered."""
    refinement = replace(RefinementSettings(), certify_checks=certify_checks)
    context = build_context(ExecutiveConfig("soccer", "waypoints", Settings(seed=3, refinement=refinement)), SENDER)
    ticks, outputs = [], []

    def on_tick(tick, published):
        ticks.append(tick)
        outputs.append(published)

    world = make_world(context.domain.robot, "waypoints", 3)
    run_lockstep(context, world, limit_s=5.0, new_budget=partial(CheckBudget, checks), on_tick=on_tick)
    return context, ticks, outputs


@pytest.fixture(scope="module")
def certified():
    return run(300)


def test_optimality_gap_is_reported_once_the_search_is_finished(certified):
    reports = messages_of(certified[2], RefinementReport)
    proven = [report for report in reports if report.gap_pct >= 0]
    assert proven
    assert all(report.finished for report in proven)
    assert proven[-1].gap_pct <= 5.0
    gaps = [report.gap_pct for report in proven if report.checks == proven[0].checks]
    assert gaps == sorted(gaps, reverse=True)


def test_replay_of_the_same_checks_reports_the_same_gaps(certified):
    context, ticks, outputs = certified
    again = [published for _, published in replay(context, iter(ticks))]
    assert messages_of(again, RefinementReport) == messages_of(outputs, RefinementReport)


def test_proof_changes_no_decision(certified):
    _, _, unproven = run(0)
    assert messages_of(unproven, Subgoals) == messages_of(certified[2], Subgoals)
    assert all(report.gap_pct == -1.0 for report in messages_of(unproven, RefinementReport))
