"""Explain the choice of subgoals: predicted durations of the alternatives, the greedy choice, and the search effort."""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any

from rich.console import Console

from tailor.tools.cli.extras import require
from tailor.tools.cli.output_files import check_output, whole_output
from tailor.tools.cli.plain_text import plain
from tailor.tools.viewer.decisions.explained_decisions import ExplainedDecision, explained_decisions
from tailor.tools.viewer.decisions.explanation_text import certified_gap_pct, duration_table, explanation_lines
from tailor.tools.viewer.event_fields import number
from tailor.tools.viewer.explainer import fields_of
from tailor.tools.viewer.explanations.explanation import Explanation

MAX_ROWS = 60  # of a picture: one of an hour has 480, takes minutes and gigabytes, and no browser shows it


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
        require("plots")
    free, values, drawn = False, list[dict[str, Any]](), list[tuple[str, Explanation]]()
    for explained in explained_decisions(arguments.recording, arguments.at, arguments.sender):
        free = free or explained.explanation is not None
        if arguments.json:
            values.append(_json_value(explained))
        else:
            _show(explained)
        if output is not None and explained.explanation is not None:
            drawn.append((explained.title, explained.explanation))
    if output is not None and drawn:
        _draw(drawn, output)
    if arguments.json:  # last: a command that fails has no result
        print(json.dumps(values, allow_nan=False))
    return 0 if free else 1


def _show(explained: ExplainedDecision) -> None:
    console = Console(soft_wrap=True, markup=False, highlight=False)  # names come from the recording
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
    decision, explanation, report = explained.decision, explained.explanation, explained.decision.search.report
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
        "deliberation_s": decision.search.deliberation_s,
        "actual_s": None if decision.finished is None else decision.finished.actual_s,
    }


def _draw(explained: Sequence[tuple[str, Explanation]], output: Path) -> None:
    """Write the picture, or a page that contains it, of the first decisions that fit."""
    from tailor.tools.figures.alternatives import draw_alternatives  # imports matplotlib, which is slow
    from tailor.tools.figures.report_page import image, page

    rows = accumulate(len(each.parameters) for _, each in explained)
    drawn = explained[: max(1, sum(each <= MAX_ROWS for each in rows))]
    with whole_output(output) as whole:
        if output.suffix.lower() == ".png":
            draw_alternatives(drawn, whole)
        else:
            with tempfile.TemporaryDirectory() as folder:
                picture = Path(folder) / "alternatives.png"
                draw_alternatives(drawn, picture)
                body = [image(picture, "predicted durations over the free parameters")]
            whole.write_text(page("Why these subgoals", body), encoding="utf-8")
    print(output, file=sys.stderr)  # stdout may hold JSON
    if len(drawn) < len(explained):
        print(f"the first {len(drawn)} of {len(explained)} decisions are drawn; --at T draws one", file=sys.stderr)
