"""Say why subgoals were chosen: predicted durations of the alternatives, what greedy would have done, what it took."""

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
from rich.markup import escape

from tailor.schemas.errors import UsageError
from tailor.tools.viewer.decisions import Decision, acted_on, decisions_of, in_force
from tailor.tools.viewer.event_fields import number
from tailor.tools.viewer.explainer import Explainer, fields_of
from tailor.tools.viewer.explanation_text import advice, durations, effort, in_words, nearness, proven, seen
from tailor.tools.viewer.explanations.explanation import Explanation
from tailor.tools.viewer.recorded_messages import timed

NAMED = 3  # actions of a sequence; a word that the arm writes has dozens


@dataclass(frozen=True, slots=True)
class Reason:
    """A decision with its explanation; None where nothing was free to choose."""

    decision: Decision
    explanation: Explanation | None
    best_cost: float = math.inf  # that a long search finds

    @property
    def title(self) -> str:
        """When, and which actions."""
        actions = self.decision.subgoals.actions
        names = ", then ".join(a.action + " (asserted subgoal)" * a.asserted for a in actions[:NAMED])
        more = f" and {len(actions) - NAMED} more" if len(actions) > NAMED else ""
        return f"{self.decision.at_s:.1f} s: {names}{more}"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor why`."""
    parser.add_argument("recording", type=Path, help="MCAP file; the models that it names must be installed")
    parser.add_argument("--at", type=float, metavar="T", help="only the decision in force T seconds after its begin")
    parser.add_argument(
        "-o", "--output", type=Path, help="draw the alternatives as Figure 11 does: a .png or .html file"
    )
    parser.add_argument("--sender", default="", metavar="ID", help="only executives whose id begins so")
    parser.add_argument("--json", action="store_true", help="tell it as JSON, with every alternative's prediction")


def run(arguments: argparse.Namespace) -> int:
    """Explain; 0 when there was something to explain, 1 when nothing was free to choose."""
    output: Path | None = arguments.output
    if output is not None and output.suffix not in (".png", ".html"):
        raise UsageError(f"--output {output}: expected a .png or .html file")
    reasons = reasons_of(arguments.recording, arguments.at, arguments.sender)
    if arguments.json:
        print(json.dumps([_told(reason) for reason in reasons], allow_nan=False))
    else:
        _show(reasons)
    explained = [(reason.title, reason.explanation) for reason in reasons if reason.explanation is not None]
    if output is not None and explained:
        _draw(explained, output)
    return 0 if explained else 1


def reasons_of(recording: Path, at_s: float | None = None, sender: str = "") -> list[Reason]:
    """The decisions that were acted on, or the one in force at a moment, explained.

    Raises:
      UsageError: No recording, no decision in it, or its models are not installed.
    """
    found = decisions_of(timed(recording, sender))
    at = None if at_s is None else in_force(found.decisions, at_s)
    decisions = list(acted_on(found.decisions)) if at_s is None else [at] if at is not None else []
    if not decisions:
        raise UsageError(f"{recording}: {_no_decision(found.decisions, at_s)}")
    explainer = Explainer()
    explainer.learn(found.provenance)
    if explainer.missing:
        raise UsageError(f"{recording}: cannot load what it was made with: {explainer.missing}")
    return [_reason(explainer, decision) for decision in decisions]


def _no_decision(decisions: Sequence[Decision], at_s: float | None) -> str:
    if at_s is None or not decisions:
        return "no decision, expected a run"
    return f"no decision before {at_s:g} s, expected --at from {decisions[0].at_s:.1f} s on"


def _reason(explainer: Explainer, decision: Decision) -> Reason:
    explanation = explainer.explanation(decision.subgoals)
    if explanation is None:
        return Reason(decision, None)
    return Reason(decision, explanation, explainer.best_cost(decision.subgoals))


def _show(reasons: Sequence[Reason]) -> None:
    console = Console(soft_wrap=True)
    for reason in reasons:
        if reason.explanation is None:
            console.print(f"[bold]{reason.title}[/bold]\n  nothing was free to choose\n", highlight=False)
            continue
        console.print(f"[bold]{reason.title}[/bold]", highlight=False)
        console.print(durations(reason.explanation))
        for of in reason.explanation.parameters:
            console.print(f"  {in_words(of)}", highlight=False)
        for situation in reason.explanation.situations:
            console.print(f"  {seen(situation)}", highlight=False)
            if situation.rule:
                console.print(f"    {escape(situation.rule)}", highlight=False)
        console.print(f"  {nearness(reason.explanation.chosen_cost, reason.best_cost)}", highlight=False)
        console.print(f"  {proven(reason.decision.report)}", highlight=False)
        if reason.decision.report is not None and (advised := advice(reason.decision.report)):
            console.print(f"  {advised}", highlight=False)
        console.print(f"  {effort(reason.decision)}\n", highlight=False)


def _told(reason: Reason) -> dict[str, Any]:
    decision, report = reason.decision, reason.decision.report
    return {
        "at_s": decision.at_s,
        "actions": [action.action for action in decision.subgoals.actions],
        "explanation": None if reason.explanation is None else fields_of(reason.explanation),
        "rules": [] if reason.explanation is None else [seen.rule for seen in reason.explanation.situations],
        "best_cost": number(reason.best_cost),
        "search": None
        if report is None
        else {
            "solver": report.solver,
            "evaluations": report.evaluations,
            "checks": report.checks,
            "p_slowdown": report.p_slowdown if report.p_slowdown >= 0 else None,
            "kept_greedy": report.kept_greedy,
            "gap_pct": report.gap_pct if report.gap_pct >= 0 else None,
        },
        "thinking_s": decision.work_s,
        "actual_s": None if decision.finished is None else decision.finished.actual_s,
    }


def _draw(explained: Sequence[tuple[str, Explanation]], output: Path) -> None:
    """The picture itself, or a page around it."""
    from tailor.tools.figures.alternatives import (
        draw_alternatives,  # with matplotlib: only who wants a picture waits for it
    )
    from tailor.tools.figures.report_page import image, page

    if output.suffix == ".png":
        draw_alternatives(explained, output)
    else:
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "alternatives.png"
            draw_alternatives(explained, picture)
            body = [image(picture, "predicted durations over the free parameters")]
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(page("Why these subgoals", body), encoding="utf-8")
    print(output, file=sys.stderr)  # stdout may be read by a program
