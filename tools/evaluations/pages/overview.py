"""First page of the report: all evaluations that were run, with their main figures and links."""

from __future__ import annotations

import html
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.pages.column_titles import column_title
from tailor.tools.evaluations.pages.report import shown
from tailor.tools.evaluations.pages.stored_results import stored_result
from tailor.tools.figures.report_page import page, table

ROWS_MAX = 6
# Main columns of all evaluations, in order.
MAIN = (
    "scenario", "domain", "robot", "action", "chosen_in", "model", "run", "start", "mode", "space", "learner",
    "setting", "gathered", "joule_worth_s", "training_data", "horizon", "n", "episodes", "mae_s", "mae_ci95",
    "noise_floor_s", "over_floor", "accuracy_pct", "failure_accuracy_pct", "constant_accuracy_pct",
    "missed_failures_pct", "mean_greedy_s", "mean_refined_s", "mean_lockstep_s", "mean_s", "duration_s",
    "improvement_pct", "ci95", "p_value", "total_pct", "slower_pct", "failed", "contacts_pct_greedy",
    "contacts_pct_refined", "oracle_pct", "regret_pct", "correlation", "success_before_pct", "success_after_pct",
    "baseline_success_pct", "needless_pct", "needless_slower_pct", "after_slower_pct", "after_to_baseline_pct",
    "difference_pct", "ci95_pct", "equivalent",
)  # fmt: skip


def write_overview(folder: Path, names: Sequence[str]) -> Path:
    """Write index.html: a section for each evaluation with a page, and a list of the missing ones.

    Args:
      folder: Folder of the pages; created if missing.
      names: All evaluations, in order.
    """
    results = {name: stored_result(folder, name) for name in names}
    missing = [name for name, result in results.items() if result is None]
    body = [_section(folder, name, result) for name, result in results.items() if result is not None]
    if missing:
        body.append(f"<p>Not run: {html.escape(', '.join(missing))}.</p>")
    path = folder / "index.html"
    with whole_output(path) as whole:
        whole.write_text(page("Tailor: evaluations", body), encoding="utf-8")
    return path


def _section(folder: Path, name: str, report: Mapping[str, Any]) -> str:
    """Title with a link, time of the run, main figures of the first rows."""
    when = time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime((folder / f"{name}.json").stat().st_mtime))
    every: list[dict[str, Any]] = report["rows"]
    rows = every if len(every) <= ROWS_MAX else [*every[: ROWS_MAX - 1], every[-1]]  # the last is often the mean
    columns = [column for column in MAIN if any(column in row for row in rows)]
    cells = [["" if row.get(column) is None else shown(row[column]) for column in columns] for row in rows]
    titles = [column_title(column) for column in columns]
    if len(rows) < len(every):
        left_out = [f"{len(every) - len(rows)} rows are on its page", *[""] * (len(columns) - 1)]
        cells.insert(-1, left_out)  # else the last row passes for the next one
    heading = f'<h2><a href="{name}.html">{html.escape(report["title"])}</a></h2>'
    return f"{heading}{table(f'{name}, {when}', titles, cells)}"
