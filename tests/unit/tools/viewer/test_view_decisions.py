"""`tailor why` finds the executed decisions and the effort of each search."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.schemas import messages as m
from tailor.tools.commands.look import why
from tailor.tools.viewer.decisions import decisions_of, executed, in_force
from tailor.tools.viewer.explanation_text import certificate_text, certified_gap_pct
from tailor.tools.viewer.recorded_messages import Timed
from tests.support import synthetic_run

BEGIN = m.Subgoals(0, 5, 2, ())


def report(tick: int, checks: int, best_s: float = 9.0) -> m.RefinementReport:
    return m.RefinementReport(0, tick, 2, "ChainSolver", False, 100 * checks, checks, 10.0, best_s)


def tick(number: int, work_ms: int) -> m.TickReport:
    return m.TickReport(0, number, 0, 0, 1_000_000, work_ms * 1_000_000, 0, 9, "", False)


def log_of(*messages: m.Message):
    return decisions_of(Timed(k / 10, "exec/x", message) for k, message in enumerate(messages))


def soccer():
    return decisions_of(Timed(t.time_ns / 1e9, t.key, t.message) for t in synthetic_run.soccer_run())


def test_each_action_has_the_decision_that_it_was_started_with() -> None:
    decisions = list(executed(soccer().decisions))
    assert [d.subgoals.actions[0].action for d in decisions] == ["approachBall", "dribbleBall"]
    assert [d.finished.outcome for d in decisions] == ["done", "done"]
    assert decisions[0].at_s == pytest.approx(0.3)


def test_a_moment_has_the_decision_in_force() -> None:
    decisions = soccer().decisions
    assert in_force(decisions, 0.1) is None
    assert in_force(decisions, 3.0).subgoals.actions[0].action == "approachBall"
    assert in_force(decisions, 99.0).subgoals.actions[0].action == "dribbleBall"


def test_the_tenths_that_are_printed_name_a_moment() -> None:
    first = soccer().decisions[0]
    for at_s, printed in ((4.23, 4.2), (4.16, 4.2), (4.16, 4.17)):
        assert in_force([dataclasses.replace(first, at_s=at_s)], printed) is not None
    assert in_force([dataclasses.replace(first, at_s=4.23)], 4.1) is None


def test_deliberation_time_counts_all_ticks_of_the_search_and_no_others() -> None:
    log = log_of(tick(4, 60), report(5, 10), BEGIN, tick(5, 61), report(6, 20, 8.5), tick(6, 31), tick(7, 50))
    (decision,) = log.decisions
    assert (decision.ticks, decision.report.checks, decision.report.best_s) == (2, 20, 8.5)
    assert decision.deliberation_s == pytest.approx(0.060 + 0.030)


def test_a_later_certificate_belongs_to_the_decision_and_adds_no_deliberation_time() -> None:
    certificate = dataclasses.replace(report(5, 20, 8.5), tick=7, gap_pct=0.8)
    log = log_of(tick(4, 60), report(5, 20, 8.5), BEGIN, tick(5, 61), tick(7, 50), certificate)
    (decision,) = log.decisions
    assert decision.report.gap_pct == 0.8
    assert decision.ticks == 1
    assert certificate_text(certified_gap_pct(decision.report, 8.5)) == "certified: within 0.8 % of the models' optimum"
    assert "not certified" in certificate_text(certified_gap_pct(report(5, 20), 8.5))


def test_a_choice_that_is_not_the_best_of_its_search_is_certified_for_what_it_costs_more() -> None:
    certificate = dataclasses.replace(report(5, 20, 8.0), gap_pct=1.0)
    assert certified_gap_pct(certificate, 8.4) == pytest.approx(100 * (1.05 * 1.01 - 1))
    assert certified_gap_pct(certificate, float("inf")) is None
    assert certified_gap_pct(dataclasses.replace(certificate, best_s=0.0), 8.4) is None
    assert certified_gap_pct(None, 8.4) is None


def test_a_new_search_does_not_count_for_the_old_decision() -> None:
    log = log_of(report(5, 40), BEGIN, report(9, 10))
    assert log.decisions[0].report.checks == 40


def test_the_search_of_the_next_decision_does_not_count_for_one_whose_action_has_ended() -> None:
    """It may count more checks than the one before, as if it went on."""
    ended = m.ActionFinished(0, 8, "approachBall", 0, "done", "", 3.0, 3.1)
    log = log_of(report(5, 40), BEGIN, ended, tick(9, 60), report(9, 90, 5.0), m.Subgoals(0, 9, 2, ()))
    first, second = log.decisions
    assert (first.report.checks, second.report.checks) == (40, 90)


def test_an_old_search_does_not_count_for_a_new_decision() -> None:
    log = log_of(report(5, 40), BEGIN, m.Subgoals(0, 30, 2, ()))
    assert log.decisions[1].report is None


def test_names_in_a_recording_are_neither_markup_nor_control_characters(capsys) -> None:
    """A closing tag that closes nothing ended the command in a traceback."""
    action = m.InstantiatedAction("[/bold]\x1b[31m", 1, False, 1.0, 0.1)
    decision = dataclasses.replace(soccer().decisions[0], subgoals=m.Subgoals(0, 5, 2, (action,)))
    why._show([why.ExplainedDecision(decision, None)])
    assert r"[/bold]\x1b[31m" in capsys.readouterr().out
