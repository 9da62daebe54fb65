"""Benchmark of growth: curves of planning, refinement, training, recordings and ticks, drawn into one picture."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator
from rich.console import Console
from rich.table import Table

from tailor.tools.benchmarks.growth import planning, recording, refining, ticks, training
from tailor.tools.benchmarks.growth.curve import Curve

PARTS: Mapping[str, Callable[[bool], Iterator[Curve]]] = {
    "planning": planning.curves,
    "refining": refining.curves,
    "training": training.curves,
    "recording": recording.curves,
    "ticks": ticks.curves,
}
COLUMNS = 3


def run(console: Console, quick: bool, output: Path) -> None:
    """Print a row for each curve, write their points as JSON and draw them beside it.

    Args:
      console: Receives the table.
      quick: Smaller work.
      output: JSON file; the picture has its name with the suffix .png.

    Raises:
      NoMeasurement: A curve has no points.
    """
    measured: list[Curve] = []
    output.parent.mkdir(parents=True, exist_ok=True)
    for name, part in PARTS.items():
        with console.status(name):
            measured += list(part(quick))
        _write(measured, output)  # after each part, because all of them take long
    table = Table("curve", "work", "from", "to", "exponent", "allowed", "", title="growth")
    for curve in measured:
        first, last = (f"{work:g}: {cost:.3g}" for work, cost in (curve.points[0], curve.points[-1]))
        remark = "grows too fast" if curve.too_fast else ""
        table.add_row(curve.name, curve.work, first, last, f"{curve.exponent:.2f}", f"{curve.allowed:.0f}", remark)
    console.print(table)
    console.print(f"{output}, {output.with_suffix('.png')}")


def _write(curves: Sequence[Curve], output: Path) -> None:
    output.write_text(json.dumps([curve.fields() for curve in curves], indent=1) + "\n")
    draw(curves, output.with_suffix(".png"))


def draw(curves: Sequence[Curve], path: Path) -> None:
    """One plot a curve, logarithmic axes; a dotted line shows the growth that is allowed."""
    rows = -(-len(curves) // COLUMNS)
    figure = Figure(figsize=(4 * COLUMNS, 2.8 * rows), layout="constrained")
    plots = figure.subplots(rows, COLUMNS, squeeze=False).flat
    for plot in plots:
        plot.set_visible(False)
    for plot, curve in zip(figure.axes, curves, strict=False):
        work, cost = zip(*curve.points, strict=True)
        plot.set_visible(True)
        plot.loglog(work, cost, "o-", color="#d62728" if curve.too_fast else "#1f77b4")
        plot.loglog(work, [cost[-1] * (w / work[-1]) ** curve.allowed for w in work], ":", color="grey")
        plot.set_title(f"{curve.name}: exponent {curve.exponent:.1f}, allowed {curve.allowed:.0f}", fontsize="small")
        plot.set_xlabel(curve.work, fontsize="small")
        plot.set_ylabel(curve.cost, fontsize="small")
        plot.set_xticks(work, [f"{w:g}" for w in work], fontsize="small")  # the powers of ten say less than the points
        plot.yaxis.set_major_formatter("{x:g}")
        plot.yaxis.set_minor_formatter("{x:g}" if max(cost) < 10 * min(cost) else NullFormatter())
        plot.xaxis.set_minor_locator(NullLocator())
        plot.grid(alpha=0.3)
    figure.savefig(path, dpi=100)
