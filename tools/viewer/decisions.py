"""The decisions of a run: which subgoals were in force when an action started, and what it took to find them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from tailor.schemas.messages import ActionFinished, ExecStatus, Provenance, RefinementReport, Subgoals, TickReport
from tailor.tools.viewer.recorded_messages import Timed


@dataclass(frozen=True, slots=True)
class Decision:
    """Subgoals, when they came into force, the search behind them, and the action that was started with them."""

    at_s: float  # when the action started; when the subgoals were told, for those that started none
    subgoals: Subgoals
    report: RefinementReport | None
    work_s: float  # spent thinking, over all ticks of the search
    ticks: int  # of the search
    started: bool = False
    finished: ActionFinished | None = None


@dataclass(slots=True)
class Run:
    """What `why` needs of a run."""

    provenance: str = ""
    decisions: list[Decision] = field(default_factory=list)


def decisions_of(messages: Iterable[Timed]) -> Run:
    """The decisions in order: one for every started action, and those that were replaced before or while it ran."""
    told = list(messages)
    work_s = {t.message.tick: _thinking_s(t.message) for t in told if isinstance(t.message, TickReport)}
    run, action = Run(), (-1, "")
    search: list[RefinementReport] = []
    for t in told:
        message = t.message
        if isinstance(message, Provenance):
            run.provenance = run.provenance or message.json
        elif isinstance(message, RefinementReport) and search and _proves(message, search[-1]):
            proven = [*search[:-1], replace(message, tick=search[-1].tick)]  # its ticks are not the search's
            if run.decisions and run.decisions[-1].report is search[-1]:
                run.decisions[-1] = replace(run.decisions[-1], report=proven[-1])
            search = proven
        elif isinstance(message, RefinementReport):
            goes_on = bool(search) and message.checks > search[-1].checks
            search = [*search, message] if goes_on else [message]
            if goes_on and run.decisions and run.decisions[-1].report is search[-2]:
                run.decisions[-1] = replace(run.decisions[-1], **_effort(search, work_s))
        elif isinstance(message, Subgoals):
            run.decisions.append(_decided(t.at_s, message, search, work_s))
        elif isinstance(message, ExecStatus):
            now = (message.action_index if message.action else -1, message.action)
            if now != action and message.action and run.decisions:
                run.decisions[-1] = replace(run.decisions[-1], at_s=t.at_s, started=True)
            action = now
        elif isinstance(message, ActionFinished) and run.decisions:
            run.decisions[-1] = replace(run.decisions[-1], finished=message)
    return run


def _proves(message: RefinementReport, last: RefinementReport) -> bool:
    """Whether a report tells no more of the search than the last one did, but how near it is to the optimum."""
    same = (message.evaluations, message.checks, message.best_s) == (last.evaluations, last.checks, last.best_s)
    return same and message.gap_pct >= 0


def in_force(decisions: Iterable[Decision], at_s: float) -> Decision | None:
    """The decision that was in force at a moment; None before the first."""
    found = None
    for decision in decisions:
        if decision.at_s <= at_s:
            found = decision
    return found


def acted_on(decisions: Iterable[Decision]) -> Iterator[Decision]:
    """The decisions with which actions were started or brought to their end."""
    return (decision for decision in decisions if decision.started or decision.finished is not None)


def _decided(at_s: float, subgoals: Subgoals, search: list[RefinementReport], work_s: dict[int, float]) -> Decision:
    """A decision of the search that reported last, if it did so in the tick before or in the same one."""
    fresh = bool(search) and search[-1].tick >= subgoals.tick - 1
    return Decision(at_s, subgoals, **_effort(search if fresh else [], work_s))


def _effort(search: list[RefinementReport], work_s: dict[int, float]) -> dict[str, Any]:
    ticks = {report.tick for report in search}
    spent_s = sum(work_s.get(tick, 0.0) for tick in ticks)
    return {"report": search[-1] if search else None, "work_s": spent_s, "ticks": len(ticks)}


def _thinking_s(report: TickReport) -> float:
    return max(0, report.work_ns - report.control_ns) / 1e9
