"""Two runs over each other: every axis of the command over time, and the actions' durations."""

from __future__ import annotations

from pathlib import Path

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tailor.tools.cli.plain_text import plain
from tailor.tools.recordings.comparison import ComparedRun

COLOURS = ("#1f77b4", "#d62728")


@rc_context({"text.parse_math": False})  # names of recordings and actions are no formulas
def draw_comparison(a: ComparedRun, b: ComparedRun, path: Path) -> None:
    """Draw into a PNG; its folder is made."""
    axes_count = max(a.commands.shape[1], b.commands.shape[1]) - 1
    figure = Figure(figsize=(10, 2.2 * (axes_count + 1)), layout="constrained")
    plots = figure.subplots(axes_count + 1, 1, squeeze=False)[:, 0]
    for number, plot in enumerate(plots[:-1], start=1):
        _draw_axis(plot, (a, b), number)
    _draw_durations(plots[-1], (a, b))
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)


def _draw_axis(plot: Axes, runs: tuple[ComparedRun, ComparedRun], number: int) -> None:
    for run, colour in zip(runs, COLOURS, strict=True):
        if run.commands.shape[1] > number:
            plot.plot(run.commands[:, 0], run.commands[:, number], color=colour, label=run.name, linewidth=1)
    plot.set_ylabel(f"command {next(run.axes[number - 1] for run in runs if len(run.axes) >= number)}")
    plot.set_xlabel("time since the first motion [s]")
    plot.legend(loc="upper right", fontsize="small")
    plot.grid(alpha=0.3)


def _draw_durations(plot: Axes, runs: tuple[ComparedRun, ComparedRun]) -> None:
    """One bar a run, one block an action, a mark where the model put its end."""
    for row, (run, colour) in enumerate(zip(runs, COLOURS, strict=True)):
        start_s = 0.0
        for action in run.actions:
            (bar,) = plot.barh(row, action.actual_s, left=start_s, color=colour, alpha=0.45, edgecolor="white")
            plot.plot([start_s + action.predicted_s] * 2, [row - 0.4, row + 0.4], color="black", linewidth=1)
            plot.text(start_s, row, f" {plain(action.action)}", va="center", fontsize="x-small", clip_path=bar)
            start_s += action.actual_s
    plot.set_yticks(range(len(runs)), [run.name for run in runs])
    plot.invert_yaxis()
    plot.set_xlabel("time in actions [s] (line: predicted end)")
