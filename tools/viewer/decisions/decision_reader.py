"""Decisions of a run: the subgoals in force when an action started, and the search that found them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tailor.runtime.newest import Newest
from tailor.schemas.messages import (
    ActionFinished,
    Contexts,
    ExecStatus,
    Message,
    Provenance,
    RefinementReport,
    Subgoals,
    TickReport,
)
from tailor.tools.viewer.decisions.recorded_search import RecordedSearch
from tailor.tools.viewer.timed_messages import Timed

MAX_EXECUTIVES = 32  # whose provenance is remembered; a flood of sender ids must not grow this process


@dataclass(slots=True)
class Decision:
    """Subgoals, the search that found them, and the action that was started with them.

    Attributes:
      at_s: Start of the action; publication of the subgoals if they started none.
      subgoals: The choice.
      search: The search, of which nothing is known if it was not reported.
      started: Whether an action was started with these subgoals.
      finished: End of that action.
      finished_s: Time of that end.
      objects: Objects near the actions, if there were any.
      sender: The executive that decided.
      provenance: What it had stated of itself by then; empty if nothing.
    """

    at_s: float
    subgoals: Subgoals
    search: RecordedSearch
    started: bool = False
    finished: ActionFinished | None = None
    finished_s: float | None = None
    objects: Contexts | None = None
    sender: str = ""
    provenance: str = ""


class DecisionReader:
    """Finds the decisions among the messages of a run, and keeps none of them.

    Attributes:
      provenance: The first provenance of any executive, as far as it has been read.
      first_s: Time of the first decision.
      end_s: Time of the last message.
    """

    def __init__(self) -> None:
        self.provenance = ""
        self.first_s: float | None = None
        self.end_s = 0.0
        self._stated: Newest[str, str] = Newest(MAX_EXECUTIVES)  # newest provenance, by sender
        self._replaced: Decision | None = None  # the last but one: reports of its last tick may still come
        self._newest: Decision | None = None
        self._search = RecordedSearch()  # the present one
        self._tick: TickReport | None = None  # the newest
        self._objects: Contexts | None = None
        self._action = (-1, "")  # in execution

    def decisions(self, messages: Iterable[Timed]) -> Iterator[Decision]:
        """Decisions in order: one for each started action, and those that were replaced before or during it."""
        for t in messages:
            self.end_s = max(self.end_s, t.at_s)
            if isinstance(t.message, Subgoals):
                if self._replaced is not None:
                    yield self._replaced
                self._decide(t.at_s, t.message, t.sender)
            elif isinstance(t.message, Provenance):
                self._introduce(t.sender, t.message.json)
            else:
                self._note(t.at_s, t.message)
        yield from (each for each in (self._replaced, self._newest) if each is not None)

    def provenance_of(self, decision: Decision) -> str:
        """What the executive of a decision stated of itself, if it was recorded by then; else the first provenance."""
        return decision.provenance or self.provenance

    def _introduce(self, sender: str, provenance: str) -> None:
        """Note a provenance, which comes again and again; kept is the first text of several that are equal."""
        self.provenance = self.provenance or provenance
        if self._stated.get(sender) != provenance:
            self._stated.renew(sender, provenance)

    def _decide(self, at_s: float, subgoals: Subgoals, sender: str) -> None:
        """Begin a decision, with the search if that reported in the same tick or the one before."""
        self.first_s = at_s if self.first_s is None else self.first_s
        if self._newest is not None:
            self._newest.search = self._newest.search.so_far()
        report = self._search.report
        fresh = report is not None and report.tick >= subgoals.tick - 1
        objects = self._objects if self._objects is not None and self._objects.tick == subgoals.tick else None
        search = self._search if fresh else RecordedSearch()
        stated = self._stated.get(sender, "")
        decision = Decision(at_s, subgoals, search, objects=objects, sender=sender, provenance=stated)
        self._replaced, self._newest = self._newest, decision

    def _note(self, at_s: float, message: Message) -> None:
        match message:
            case Contexts():
                self._objects = message
            case TickReport():
                self._tick = message
                for search in self._searches():
                    search.note(message)
            case RefinementReport():
                if not self._search.adds(message, self._tick):
                    self._search = RecordedSearch()
                    self._search.adds(message, self._tick)
            case ExecStatus():
                self._start(at_s, message)
            case ActionFinished():
                self._search = RecordedSearch()  # the next report is of another decision, also if it counts more checks
                if self._newest is not None:
                    self._newest.finished, self._newest.finished_s = message, at_s

    def _searches(self) -> list[RecordedSearch]:
        """Those whose ticks may still be reported, each once."""
        searches = [self._search, *(each.search for each in (self._replaced, self._newest) if each is not None)]
        return list({id(search): search for search in searches}.values())

    def _start(self, at_s: float, message: ExecStatus) -> None:
        now = (message.action_index if message.action else -1, message.action)
        if now != self._action and message.action and self._newest is not None:
            self._newest.at_s, self._newest.started = at_s, True
        self._action = now


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
