"""Reports of evaluations: a table in the terminal, JSON for scripts, an HTML page with plots."""

from __future__ import annotations

import argparse
import html
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import processes
from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.pages.column_titles import column_title
from tailor.tools.figures.report_page import image, page, table
from tailor.tools.parallel.cluster import configure_cluster

Row = Mapping[str, Any]
MAX_COLUMNS = 9  # that fit a screen
LAST_SEED = 2_000_000_000  # of evaluations; gathered runs have larger ones
MIN_WIDTH = 120  # characters; files and pipes have no width


@dataclass(frozen=True, slots=True)
class Report:
    """The result of one evaluation: rows of figures, the paper's figures for comparison, remarks, plots."""

    name: str  # "table3"
    title: str
    rows: Sequence[Row]
    remarks: Sequence[str]
    plots: Mapping[str, Path]  # description -> PNG
    provenance: Mapping[str, Any]  # seeds, and hashes of what was evaluated


def configure_report(parser: argparse.ArgumentParser) -> None:
    """Declare the flags of every evaluation."""
    parser.add_argument("--jobs", type=processes, default=2, help="processes (default %(default)s)")
    configure_cluster(parser)
    parser.add_argument("--json", action="store_true", help="print the rows as JSON")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write an HTML page with plots into DIR")
    parser.add_argument("--store", type=Path, metavar="DIR", default=Path("out/evaluate"),
                        help="store finished runs in DIR and resume from them (default %(default)s)")  # fmt: skip
    parser.add_argument("--zoo", default="", help="folder of action models (default: the shipped ones)")
    parser.add_argument("--seed", type=_seed, default=None, metavar="N",
                        help="first seed, for debugging (default: from the hash of source and models)")  # fmt: skip
    parser.add_argument("--domain", default="",
                        help="domain, e.g. soccer; an evaluation of another one does not run")  # fmt: skip


def publish_report(report: Report, arguments: argparse.Namespace) -> None:
    """Print the report, and write its page and its JSON if a folder is given.

    Args:
      report: Result of an evaluation.
      arguments: Parsed flags of `configure_report`.
    """
    folder: Path | None = arguments.report
    report = _with_seeds(report)
    content = {"name": report.name, "title": report.title, "rows": [_plain(row) for row in report.rows]}
    text = json.dumps({**content, "remarks": list(report.remarks), "provenance": dict(report.provenance)}, indent=1)
    if arguments.json:
        print(text)
    else:
        _print(report)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        body = [table(report.title, *_tabled(report.rows))]
        body += [f"<p>{html.escape(remark)}</p>" for remark in report.remarks]
        body += [image(path, description) for description, path in report.plots.items()]
        figures = folder / f"{report.name}.json"
        figures.unlink(missing_ok=True)  # of an older page, which would pass for this one
        with whole_output(folder / f"{report.name}.html") as whole:
            whole.write_text(page(report.title, body), encoding="utf-8")
        with whole_output(figures) as whole:  # last and at once: marks a complete page
            whole.write_text(text + "\n", encoding="utf-8")


def _with_seeds(report: Report) -> Report:
    """The report with a remark on its seeds."""
    if "first_seed" not in report.provenance:
        return report
    first, source = report.provenance["first_seed"], str(report.provenance["source_sha256"])[:12]
    derived = f"derived from source {source} and models {str(report.provenance['models_sha256'])[:12]}"
    how = derived if report.provenance["seed_derived"] else "chosen by --seed, for debugging: not a fresh evaluation"
    return replace(report, remarks=[*report.remarks, f"seeds from {first}, {how}"])


def shown(value: object) -> str:
    """A cell as text; numbers with significant digits, a dash where there is none: too few runs have no interval."""
    if isinstance(value, float):
        if not math.isfinite(value):
            return "–"
        if value != 0 and abs(value) < 0.001:
            return f"{value:.1e}"
        return f"{value:.3f}" if abs(value) < 0.1 else f"{value:.2f}"
    if value is None:
        return ""
    if isinstance(value, tuple | list):
        parts = [shown(part) for part in value]
        return "–" if set(parts) == {"–"} else " .. ".join(parts)
    return str(value)


def _seed(text: str) -> int:
    if not text.isdecimal() or int(text) >= LAST_SEED:
        raise UsageError(f"--seed is '{text}', expected a whole number from 0 to {LAST_SEED - 1}")
    return int(text)


def _print(report: Report) -> None:
    console = Console()
    console.width = max(console.width, MIN_WIDTH)
    made = Table(title=report.title)
    head, cells = _tabled(report.rows)
    for column in head:
        made.add_column(column, justify="left" if column == head[0] else "right", no_wrap=column == head[0])
    for row in cells:
        made.add_row(*row)
    console.print(made)
    for remark in report.remarks:
        console.print(remark, highlight=False)


def _tabled(rows: Sequence[Row]) -> tuple[list[str], list[list[str]]]:
    """Head and cells; transposed if there are more columns than fit a screen."""
    columns = list(dict.fromkeys(column for row in rows for column in row))
    titles = [column_title(column) for column in columns]
    lines = [titles, *([shown(row.get(column, "")) for column in columns] for row in rows)]
    if len(columns) > MAX_COLUMNS and len(columns) > len(rows):
        lines = [list(line) for line in zip(*lines, strict=True)]
    return lines[0], lines[1:]


def _plain(value: Any) -> Any:
    """Rows and cells as JSON values: non-finite numbers become null."""
    if isinstance(value, Mapping):
        return {key: _plain(cell) for key, cell in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
