"""Explains the decisions of a recording, one after another."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.viewer.decisions.decision_reader import Decision, DecisionReader, executed, in_force
from tailor.tools.viewer.decisions.explanation_text import certified_gap_pct
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.explanations.explanation import Explanation
from tailor.tools.viewer.explanations.missing_certificate import why_not_certified
from tailor.tools.viewer.timed_messages import SHOWN_DIGITS, several_executives, timed

MAX_NAMED = 3  # actions of a sequence in a title; a word that the arm writes has dozens


@dataclass(frozen=True, slots=True)
class ExplainedDecision:
    """A decision with its explanation; None if no parameter was free."""

    decision: Decision
    explanation: Explanation | None
    best_cost: float = math.inf  # of a long search
    not_certified: str = ""  # why the choice has no certificate; empty if it has one

    @property
    def title(self) -> str:
        """Time and names of the actions."""
        actions = self.decision.subgoals.actions
        names = [action.action + " (asserted subgoal)" * action.asserted for action in actions]
        return f"{self.decision.at_s:.1f} s: {abbreviated(names, MAX_NAMED, ', then ')}"


def explained_decisions(recording: Path, at_s: float | None = None, sender: str = "") -> Iterator[ExplainedDecision]:
    """Explain the decisions that started actions, or the one in force at a time; each when it is asked for.

    Args:
      recording: MCAP file.
      at_s: Seconds since the start of the recording; None: all decisions that started actions.
      sender: Skip executives whose id does not begin with this.

    Raises:
      UsageError: The file is no recording, has no such decision, or the models of no run in it are installed; a line
        names other runs whose models are not.
    """
    reader = DecisionReader()
    found = reader.decisions(timed(recording, sender, read=lambda damage: warn(recording, damage)))
    if at_s is None:
        decisions = list(executed(found))
    else:
        newest = in_force(found, at_s)
        decisions = [] if newest is None else [newest]
    if not decisions:
        raise UsageError(f"{recording}: {_no_decision(reader, at_s)}")
    explainer = Explainer()
    owners = {reader.provenance_of(each): each.sender[:SHOWN_DIGITS] for each in decisions}
    missing = _missing(recording, explainer, owners)
    decisions = [each for each in decisions if reader.provenance_of(each) not in missing]
    if not decisions:
        raise UsageError(next(iter(missing.values())))
    for error in missing.values():
        print(plain(error), file=sys.stderr)
    if several := several_executives(recording, {each.sender: each.at_s for each in reversed(decisions)}, "decisions"):
        print(several, file=sys.stderr)
    if at_s is not None and (ended := ended_text(reader, decisions[0], at_s)):
        print(plain(f"{recording}: {ended}"), file=sys.stderr)
    return (_explained(explainer, decision, reader.provenance_of(decision)) for decision in decisions)


def _missing(recording: Path, explainer: Explainer, owners: Mapping[str, str]) -> dict[str, str]:
    """Errors of the runs whose domain or models cannot be loaded, by provenance; `owners`: executives, likewise."""
    missing = {}
    for provenance, owner in owners.items():
        explainer.load(provenance)
        if explainer.missing:
            which = f" of executive {owner}" if len(owners) > 1 else ""
            missing[provenance] = f"{recording}: cannot load its domain and models{which}: {explainer.missing}"
    return missing


def _no_decision(reader: DecisionReader, at_s: float | None) -> str:
    if reader.first_s is None:
        return "no decision, expected a run"
    if at_s is None:
        return "no decision started an action, expected a run; --at shows the others"
    return f"no decision before {at_s:g} s, expected --at from {reader.first_s:.1f} s on"


def ended_text(reader: DecisionReader, decision: Decision, at_s: float) -> str:
    """What had ended at a time for which the decision before it is shown; empty if nothing had."""
    if round(at_s, 1) > round(reader.end_s, 1):
        return f"the recording ends at {reader.end_s:.1f} s; this is its last decision"
    if decision.finished_s is not None and round(at_s, 1) > round(decision.finished_s, 1):
        return f"no decision was in force at {at_s:g} s: this one's action had ended at {decision.finished_s:.1f} s"
    return ""


def _explained(explainer: Explainer, decision: Decision, provenance: str) -> ExplainedDecision:
    explainer.load(provenance)  # a recording may hold several runs
    if decision.objects is not None:
        explainer.note(decision.objects)
    explanation = explainer.explanation(decision.subgoals)
    if explanation is None:
        return ExplainedDecision(decision, None)
    best_cost, reason = explainer.best_cost(decision.subgoals, explanation), ""
    report = decision.search.report
    if certified_gap_pct(report, explanation.chosen_cost) is None:
        reason = why_not_certified(explanation.decided, report)
    return ExplainedDecision(decision, explanation, best_cost, reason)
