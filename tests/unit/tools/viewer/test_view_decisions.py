"""`tailor why` finds the executed decisions and the effort of each search."""

from __future__ import annotations

import dataclasses
import re
import tracemalloc
from pathlib import Path

import pytest

from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas import messages as m
from tailor.schemas.errors import UsageError
from tailor.tools.commands.look import why
from tailor.tools.viewer import explainer
from tailor.tools.viewer.decisions.decision_reader import DecisionReader, executed, in_force
from tailor.tools.viewer.decisions.explained_decisions import ExplainedDecision, ended_text, explained_decisions
from tailor.tools.viewer.decisions.explanation_text import certificate_text, certified_gap_pct
from tailor.tools.viewer.timed_messages import Timed
from tests.support import synthetic_run

ROOT = Path(__file__).resolve().parents[4]
BEGIN = m.Subgoals(0, 5, 2, ())


def report(tick: int, checks: int, best_s: float = 9.0) -> m.RefinementReport:
    return m.RefinementReport(0, tick, 2, "ChainSolver", False, 100 * checks, checks, 10.0, best_s)


def tick(number: int, work_ms: int) -> m.TickReport:
    return m.TickReport(0, number, 0, 0, 1_000_000, work_ms * 1_000_000, 0, 9, "", False)


def decisions_of(*messages: m.Message):
    return list(DecisionReader().decisions(Timed(k / 10, "exec/x", message) for k, message in enumerate(messages)))


def soccer():
    return list(
        DecisionReader().decisions(Timed(t.time_ns / 1e9, t.key, t.message) for t in synthetic_run.soccer_run())
    )


def test_each_action_has_the_decision_that_it_was_started_with() -> None:
    decisions = list(executed(soccer()))
    assert [d.subgoals.actions[0].action for d in decisions] == ["approachBall", "dribbleBall"]
    assert [d.finished.outcome for d in decisions] == ["done", "done"]
    assert decisions[0].at_s == pytest.approx(0.3)


def test_a_moment_has_the_decision_in_force() -> None:
    decisions = soccer()
    assert in_force(decisions, 0.1) is None
    assert in_force(decisions, 3.0).subgoals.actions[0].action == "approachBall"
    assert in_force(decisions, 99.0).subgoals.actions[0].action == "dribbleBall"


def test_the_tenths_that_are_printed_name_a_moment() -> None:
    first = soccer()[0]
    for at_s, printed in ((4.23, 4.2), (4.16, 4.2), (4.16, 4.17)):
        assert in_force([dataclasses.replace(first, at_s=at_s)], printed) is not None
    assert in_force([dataclasses.replace(first, at_s=4.23)], 4.1) is None


def test_deliberation_time_counts_all_ticks_of_the_search_and_no_others() -> None:
    decisions = decisions_of(
        tick(4, 60), report(5, 10), BEGIN, tick(5, 61), report(6, 20, 8.5), tick(6, 31), tick(7, 50)
    )
    (decision,) = decisions
    assert (decision.search.ticks, decision.search.report.checks, decision.search.report.best_s) == (2, 20, 8.5)
    assert decision.search.deliberation_s == pytest.approx(0.060 + 0.030)


def test_a_later_certificate_belongs_to_the_decision_and_adds_no_deliberation_time() -> None:
    certificate = dataclasses.replace(report(5, 20, 8.5), tick=7, gap_pct=0.8)
    (decision,) = decisions_of(tick(4, 60), report(5, 20, 8.5), BEGIN, tick(5, 61), tick(7, 50), certificate)
    assert decision.search.report.gap_pct == 0.8
    assert decision.search.ticks == 1
    assert (
        certificate_text(certified_gap_pct(decision.search.report, 8.5), "")
        == "certified: within 0.8 % of the models' optimum"
    )
    assert certificate_text(certified_gap_pct(report(5, 20), 8.5), "no bound") == "not certified: no bound"


def test_a_choice_that_is_not_the_best_of_its_search_is_certified_for_what_it_costs_more() -> None:
    certificate = dataclasses.replace(report(5, 20, 8.0), gap_pct=1.0)
    assert certified_gap_pct(certificate, 8.4) == pytest.approx(100 * (1.05 * 1.01 - 1))
    assert certified_gap_pct(certificate, float("inf")) is None
    assert certified_gap_pct(dataclasses.replace(certificate, best_s=0.0), 8.4) is None
    assert certified_gap_pct(dataclasses.replace(certificate, best_s=5e-324), 8.4) is None, "no number of JSON"
    assert certified_gap_pct(None, 8.4) is None


def test_a_new_search_does_not_count_for_the_old_decision() -> None:
    decisions = decisions_of(report(5, 40), BEGIN, report(9, 10))
    assert decisions[0].search.report.checks == 40


def test_the_search_of_the_next_decision_does_not_count_for_one_whose_action_has_ended() -> None:
    """It may count more checks than the one before, as if it went on."""
    ended = m.ActionFinished(0, 8, "approachBall", 0, "done", "", 3.0, 3.1)
    decisions = decisions_of(report(5, 40), BEGIN, ended, tick(9, 60), report(9, 90, 5.0), m.Subgoals(0, 9, 2, ()))
    first, second = decisions
    assert (first.search.report.checks, second.search.report.checks) == (40, 90)


def test_an_old_search_does_not_count_for_a_new_decision() -> None:
    decisions = decisions_of(report(5, 40), BEGIN, m.Subgoals(0, 30, 2, ()))
    assert decisions[1].search.report is None


def test_the_ticks_of_each_run_count_for_its_own_decisions() -> None:
    """An executive that is started again counts its ticks anew."""
    runs = (report(5, 40), BEGIN, tick(5, 61)), (tick(4, 1), report(5, 40), BEGIN, tick(5, 31))
    first, second = decisions_of(*runs[0], *runs[1])
    assert (first.search.deliberation_s, second.search.deliberation_s) == (pytest.approx(0.06), pytest.approx(0.03))


def test_memory_follows_the_decisions_that_are_shown() -> None:
    """600 000 subgoals fit into 10 kB of a recording."""
    reader = DecisionReader()
    hours = (Timed(k / 10, "exec/x", each) for k in range(20_000) for each in (m.Subgoals(0, k, 2, ()), tick(k, 60)))
    tracemalloc.start()
    try:
        assert list(executed(reader.decisions(hours))) == []
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()
    assert (reader.first_s, reader.end_s) == (0.0, 1999.9)


def test_a_time_after_the_run_is_named_beside_its_last_decision(capsys) -> None:
    path = ROOT / "tests" / "data" / "golden" / "soccer-approach-dribble.mcap"
    first_ns, *_, last_ns = (each.log_ns for each in open_recording(path).messages())
    (decision,) = explained_decisions(path, 400.0)
    assert decision.explanation is None
    ends_s = (last_ns - first_ns) / 1e9
    assert f".mcap: the recording ends at {ends_s:.1f} s; this is its last decision" in capsys.readouterr().err


def test_a_time_after_the_action_of_a_decision_has_none_in_force() -> None:
    reader, end = DecisionReader(), m.ActionFinished(0, 8, "approachBall", 0, "done", "", 3.0, 3.1)
    (decision,) = reader.decisions(
        Timed(at_s, "exec/x", each) for at_s, each in ((1.0, BEGIN), (4.0, end), (9.0, tick(90, 60)))
    )
    ended = "no decision was in force at 9 s: this one's action had ended at 4.0 s"
    assert [ended_text(reader, decision, at_s) for at_s in (1.0, 3.9, 4.04, 9.0)] == ["", "", "", ended]


def two_runs(path: Path) -> Path:
    """A recording of a run of soccer and then one of the arm."""
    golden, writer = ROOT / "tests" / "data" / "golden", McapWriter(path, {})
    for number, name in enumerate(("soccer-approach-dribble", "arm-word-I")):
        for recorded in open_recording(golden / f"{name}.mcap").messages():
            own = (("sender", f"{number + 1}{recorded.sender[1:]}"), ("key", recorded.key))
            declared = dataclasses.replace(recorded.declared, metadata=own)
            later_ns = number * 30 * 10**9
            sent = (recorded.log_ns + later_ns, recorded.data, recorded.publish_ns + later_ns, recorded.sequence)
            writer.copy(recorded.key, declared, sent)
    writer.close()
    return path


def explained_names(path: Path) -> list[str]:
    explained = explained_decisions(path)
    return [each.decision.subgoals.actions[0].action for each in explained if each.explanation is not None]


def test_each_of_two_runs_in_a_file_is_explained_by_its_own_domain_and_models(tmp_path: Path, capsys) -> None:
    """The second was judged by the models of the first: nothing seemed to be free in a run of another domain."""
    assert explained_names(two_runs(tmp_path / "two.mcap")) == ["approachBall", "reach", "reach", "reach"]
    several = r"two.mcap holds decisions of 2 executives: 10{7} from 1\.\d s on, 20{7} from 30\.\d s on; --sender .*\n"
    assert re.fullmatch(several, capsys.readouterr().err)


def test_a_run_without_its_models_is_named_and_the_other_one_explained(tmp_path: Path, monkeypatch, capsys) -> None:
    path, rebuild = two_runs(tmp_path / "two.mcap"), explainer.rebuild_context

    def without(*domains: str):
        def rebuilt(provenance, load):
            if provenance["config"]["domain"] in domains:
                raise UsageError("no models")
            return rebuild(provenance, load)

        monkeypatch.setattr(explainer, "rebuild_context", rebuilt)

    without("soccer")
    assert explained_names(path) == ["reach", "reach", "reach"]
    error = f"{path}: cannot load its domain and models of executive 1{'0' * 7}: no models\n"
    assert capsys.readouterr().err == error
    without("soccer", "arm")
    with pytest.raises(UsageError, match="of executive 10000000: no models"):
        explained_decisions(path)


def test_names_in_a_recording_are_neither_markup_nor_control_characters(capsys) -> None:
    """A closing tag that closes nothing ended the command in a traceback."""
    action = m.InstantiatedAction("[/bold]\x1b[31m", 1, False, 1.0, 0.1)
    decision = dataclasses.replace(soccer()[0], subgoals=m.Subgoals(0, 5, 2, (action,)))
    why._show(ExplainedDecision(decision, None))
    assert r"[/bold]\x1b[31m" in capsys.readouterr().out
