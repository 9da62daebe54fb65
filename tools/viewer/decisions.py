"""Decisions of a run: the subgoals in force when an action started, and the search that found them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from tailor.schemas.messages import (
    ActionFinished,
    Contexts,
    ExecStatus,
    Provenance,
    RefinementReport,
    Subgoals,
    TickReport,
)
from tailor.tools.viewer.recorded_messages import Timed


@dataclass(frozen=True, slots=True)
class Decision:
    """Subgoals, the search that found them, and the action that was started with them.

    Attributes:
      at_s: Start of the action; publication of the subgoals if they started none.
      subgoals: The choice.
      report: Last report of the search.
      deliberation_s: Deliberation time over all ticks of the search.
      ticks: Number of ticks of the search.
      started: Whether an action was started with these subgoals.
      finished: End of that action.
      objects: Objects near the actions, if there were any.
    """

    at_s: float
    subgoals: Subgoals
    report: RefinementReport | None
    deliberation_s: float
    ticks: int
    started: bool = False
    finished: ActionFinished | None = None
    objects: Contexts | None = None


@dataclass(slots=True)
class DecisionLog:
    """Provenance and decisions of a run."""

    provenance: str = ""
    decisions: list[Decision] = field(default_factory=list)


def decisions_of(messages: Iterable[Timed]) -> DecisionLog:
    """Decisions in order: one for each started action, and those that were replaced before or during it."""
    received = list(messages)
    deliberation_s = {t.message.tick: _deliberation_s(t.message) for t in received if isinstance(t.message, TickReport)}
    log, action = DecisionLog(), (-1, "")
    search: list[RefinementReport] = []
    objects: Contexts | None = None
    for t in received:
        message = t.message
        if isinstance(message, Provenance):
            log.provenance = log.provenance or message.json
        elif isinstance(message, RefinementReport) and search and _certifies(message, search[-1]):
            certified = [*search[:-1], replace(message, tick=search[-1].tick)]  # the search's last tick
            if log.decisions and log.decisions[-1].report is search[-1]:
                log.decisions[-1] = replace(log.decisions[-1], report=certified[-1])
            search = certified
        elif isinstance(message, RefinementReport):
            continues = bool(search) and message.checks > search[-1].checks
            search = [*search, message] if continues else [message]
            if continues and log.decisions and log.decisions[-1].report is search[-2]:
                log.decisions[-1] = replace(log.decisions[-1], **_effort(search, deliberation_s))
        elif isinstance(message, Contexts):
            objects = message
        elif isinstance(message, Subgoals):
            mine = objects if objects is not None and objects.tick == message.tick else None
            log.decisions.append(replace(_decision(t.at_s, message, search, deliberation_s), objects=mine))
        elif isinstance(message, ExecStatus):
            now = (message.action_index if message.action else -1, message.action)
            if now != action and message.action and log.decisions:
                log.decisions[-1] = replace(log.decisions[-1], at_s=t.at_s, started=True)
            action = now
        elif isinstance(message, ActionFinished):
            search = []  # the next report is of another decision, also if it counts more checks
            if log.decisions:
                log.decisions[-1] = replace(log.decisions[-1], finished=message)
    return log


def _certifies(message: RefinementReport, last: RefinementReport) -> bool:
    """Whether a report adds only a certificate to the last one of the same search."""
    same = (message.evaluations, message.checks, message.best_s) == (last.evaluations, last.checks, last.best_s)
    return same and message.gap_pct >= 0


def in_force(decisions: Iterable[Decision], at_s: float) -> Decision | None:
    """The decision in force at a time; None before the first. The tenths that are printed count, too."""
    newest = None
    for decision in decisions:
        if min(decision.at_s, round(decision.at_s, 1)) <= at_s:
            newest = decision
    return newest


def executed(decisions: Iterable[Decision]) -> Iterator[Decision]:
    """Decisions with which actions were started or finished."""
    return (decision for decision in decisions if decision.started or decision.finished is not None)


def _decision(
    at_s: float, subgoals: Subgoals, search: list[RefinementReport], deliberation_s: dict[int, float]
) -> Decision:
    """A decision with the last search, if that reported in the same tick or the one before."""
    fresh = bool(search) and search[-1].tick >= subgoals.tick - 1
    return Decision(at_s, subgoals, **_effort(search if fresh else [], deliberation_s))


def _effort(search: list[RefinementReport], deliberation_s: dict[int, float]) -> dict[str, Any]:
    ticks = {report.tick for report in search}
    total_s = sum(deliberation_s.get(tick, 0.0) for tick in ticks)
    return {"report": search[-1] if search else None, "deliberation_s": total_s, "ticks": len(ticks)}


def _deliberation_s(report: TickReport) -> float:
    return max(0, report.work_ns - report.control_ns) / 1e9
