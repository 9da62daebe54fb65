"""Explain the choice of subgoals: predicted durations of the alternatives, the greedy choice, and the search effort."""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import check_output, whole_output
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.viewer.decisions import Decision, decisions_of, executed, in_force
from tailor.tools.viewer.event_fields import number
from tailor.tools.viewer.explainer import Explainer, fields_of
from tailor.tools.viewer.explanation_text import certified_gap_pct, duration_table, explanation_lines
from tailor.tools.viewer.explanations.explanation import Explanation
from tailor.tools.viewer.recorded_messages import timed

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


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor why`."""
    parser.add_argument("recording", type=Path, help="MCAP file; the models named in it must be installed")
    parser.add_argument("--at", type=float, metavar="T", help="only the decision in force T seconds after the start")
    parser.add_argument(
        "-o", "--output", type=Path, help="draw the alternatives like the paper's Figure 11, into a .png or .html file"
    )
    parser.add_argument("--sender", default="", metavar="ID", help="only executives whose id begins with ID")
    parser.add_argument("--json", action="store_true", help="print JSON with the predictions of all alternatives")


def run(arguments: argparse.Namespace) -> int:
    """Explain; 0 if a decision had free parameters, else 1."""
    output: Path | None = arguments.output
    if output is not None:
        check_output("--output", output, (".png", ".html"))
    decisions = explained_decisions(arguments.recording, arguments.at, arguments.sender)
    if arguments.json:
        print(json.dumps([_json_value(explained) for explained in decisions], allow_nan=False))
    else:
        _show(decisions)
    drawable = [(explained.title, explained.explanation) for explained in decisions if explained.explanation]
    if output is not None and drawable:
        _draw(drawable, output)
    return 0 if drawable else 1


def explained_decisions(recording: Path, at_s: float | None = None, sender: str = "") -> list[ExplainedDecision]:
    """Explain the decisions that started actions, or the one in force at a time.

    Args:
      recording: MCAP file.
      at_s: Seconds since the start of the recording; None: all decisions that started actions.
      sender: Skip executives whose id does not begin with this.

    Raises:
      UsageError: The file is no recording, has no decision, or its models are not installed.
    """
    log = decisions_of(timed(recording, sender, read=lambda damage: warn(recording, damage)))
    at = None if at_s is None else in_force(log.decisions, at_s)
    decisions = list(executed(log.decisions)) if at_s is None else [at] if at is not None else []
    if not decisions:
        raise UsageError(f"{recording}: {_no_decision(log.decisions, at_s)}")
    explainer = Explainer()
    explainer.load(log.provenance)
    if explainer.missing:
        raise UsageError(f"{recording}: cannot load its domain and models: {explainer.missing}")
    return [_explained(explainer, decision) for decision in decisions]


def _no_decision(decisions: Sequence[Decision], at_s: float | None) -> str:
    if at_s is None or not decisions:
        return "no decision, expected a run"
    return f"no decision before {at_s:g} s, expected --at from {decisions[0].at_s:.1f} s on"


def _explained(explainer: Explainer, decision: Decision) -> ExplainedDecision:
    if decision.objects is not None:
        explainer.note(decision.objects)
    explanation = explainer.explanation(decision.subgoals)
    if explanation is None:
        return ExplainedDecision(decision, None)
    best_cost, reason = explainer.best_cost(decision.subgoals), ""
    if certified_gap_pct(decision.report, explanation.chosen_cost) is None:
        reason = explainer.why_not_certified(decision.subgoals, decision.report)
    return ExplainedDecision(decision, explanation, best_cost, reason)


def _show(decisions: Sequence[ExplainedDecision]) -> None:
    console = Console(soft_wrap=True, markup=False, highlight=False)  # names come from the recording
    for explained in decisions:
        console.print(plain(explained.title), style="bold")
        lines = ["no parameter was free"]
        if explained.explanation is not None:
            console.print(duration_table(explained.explanation))
            known = (explained.best_cost, explained.decision, explained.not_certified)
            lines = explanation_lines(explained.explanation, *known)
        for line in lines:
            console.print(f"  {plain(line)}")
        console.print()


def _json_value(explained: ExplainedDecision) -> dict[str, Any]:
    decision, explanation, report = explained.decision, explained.explanation, explained.decision.report
    return {
        "at_s": decision.at_s,
        "actions": [action.action for action in decision.subgoals.actions],
        "explanation": None if explanation is None else fields_of(explanation),
        "rules": [] if explanation is None else [situation.rule for situation in explanation.situations],
        "best_cost": number(explained.best_cost),
        "certified_gap_pct": None if explanation is None else certified_gap_pct(report, explanation.chosen_cost),
        "not_certified": explained.not_certified,
        "search": None
        if report is None
        else {
            "solver": report.solver,
            "evaluations": report.evaluations,
            "checks": report.checks,
            "gap_pct": report.gap_pct if report.gap_pct >= 0 else None,
        },
        "deliberation_s": decision.deliberation_s,
        "actual_s": None if decision.finished is None else decision.finished.actual_s,
    }


def _draw(explained: Sequence[tuple[str, Explanation]], output: Path) -> None:
    """Write the picture, or a page that contains it."""
    from tailor.tools.figures.alternatives import draw_alternatives  # imports matplotlib, which is slow
    from tailor.tools.figures.report_page import image, page

    with whole_output(output) as whole:
        if output.suffix.lower() == ".png":
            draw_alternatives(explained, whole)
        else:
            with tempfile.TemporaryDirectory() as folder:
                picture = Path(folder) / "alternatives.png"
                draw_alternatives(explained, picture)
                body = [image(picture, "predicted durations over the free parameters")]
            whole.write_text(page("Why these subgoals", body), encoding="utf-8")
    print(output, file=sys.stderr)  # stdout may hold JSON
