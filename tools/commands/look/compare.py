"""Compare two recorded runs: commands, plans, subgoals and durations, as tables and optionally as plots."""

from __future__ import annotations

import argparse
import json
import math
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path
from typing import Any

from rich.table import Table

from tailor.schemas.messages import ActionFinished, PlanReport
from tailor.schemas.reason_text import reason_text
from tailor.tools.cli.extras import require
from tailor.tools.cli.output_files import check_output, whole_output
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.terminal import table_console
from tailor.tools.recordings.comparison import ComparedRun, chosen, command_differences, compared_run


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor compare`."""
    parser.add_argument("first", type=Path, help="recording (MCAP) of a run")
    parser.add_argument("second", type=Path, help="recording of another run, e.g. with other models")
    parser.add_argument("--plot", type=Path, metavar="PNG", help="draw commands and durations")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """0 if results and commands are equal, 1 if not."""
    if arguments.plot:
        check_output("--plot", arguments.plot, (".png",))
        require("plots")
    a, b = compared_run(arguments.first), compared_run(arguments.second)
    comparison = _comparison(a, b)
    if arguments.plot:  # first: a command that fails has no result
        from tailor.tools.figures.comparison_plot import draw_comparison

        with whole_output(arguments.plot) as picture:
            draw_comparison(replace(a, name=plain(a.name)), replace(b, name=plain(b.name)), picture)
    if arguments.json:
        print(json.dumps(comparison))
    else:
        _show(a, b, comparison)
    return 0 if comparison["equal"] else 1


def _comparison(a: ComparedRun, b: ComparedRun) -> dict[str, Any]:
    found = command_differences(a, b).items()
    apart = {name: round(value, 6) if math.isfinite(value) else None for name, value in found}
    same_commands = a.axes == b.axes and apart["first_s"] is None and len(a.commands) == len(b.commands)
    return {
        "equal": same_commands and a.result == b.result,
        "commands": apart,
        **{
            side: {
                "file": run.name,
                "result": run.result,
                "total_s": round(run.total_s, 3),
                "axes": list(run.axes),
                "actions": [_action(action) for action in run.actions],
                "plans": [plan.plan for plan in run.plans],
                "subgoals": [chosen(subgoals) for subgoals in run.subgoals],
            }
            for side, run in (("first", a), ("second", b))
        },
    }


def _action(action: ActionFinished) -> dict[str, Any]:
    return {
        "action": action.action,
        "outcome": action.outcome,
        "predicted_s": round(action.predicted_s, 3),
        "actual_s": round(action.actual_s, 3),
    }


def _show(a: ComparedRun, b: ComparedRun, comparison: dict[str, Any]) -> None:
    console = table_console()
    actions = [[_brief(action) for action in run.actions] for run in (a, b)]
    console.print(_side_by_side("action, predicted → actual s", a, b, *actions))
    console.print(_side_by_side("subgoals, free parameters", a, b, *[_changes(run) for run in (a, b)]))
    console.print(_side_by_side("plans", a, b, *[_distinct([_steps(plan) for plan in run.plans]) for run in (a, b)]))
    total = f"{a.total_s:.2f} s against {b.total_s:.2f} s"
    if a.total_s > 0:
        total += f" ({b.total_s / a.total_s - 1:+.1%})"
    console.print(f"durations: {total}; results: {plain(a.result) or 'none'}, {plain(b.result) or 'none'}")
    apart = comparison["commands"]
    for line in _unlike(a, b):
        console.print(plain(line))
    if apart["max"] is None:
        console.print("commands: not compared, as no axis is of both runs")
    elif apart["first_s"] is None:
        console.print(f"commands: equal over {apart['seconds']:.1f} s")
    else:
        first, rms, largest = (apart[name] for name in ("first_s", "rms", "max"))
        console.print(f"commands: first differ {first:.1f} s after the start; RMS {rms:.3f}, largest {largest:.3f}")


def _unlike(a: ComparedRun, b: ComparedRun) -> Iterator[str]:
    """What the differences of the commands leave out: other axes, and the end of the longer run."""
    if a.axes != b.axes:
        left, right = (", ".join(run.axes) or "none" for run in (a, b))
        if not set(a.axes) & set(b.axes):
            yield f"axes: {left} against {right}"
            return
        yield f"axes: {left} against {right}; compared in this order, as far as both have them"
    if len(a.commands) != len(b.commands):
        yield f"number of commands: {len(a.commands)} against {len(b.commands)}; compared as far as both go"


def _brief(action: ActionFinished) -> str:
    outcome = "" if action.outcome == "done" else f" ({action.outcome})"
    return f"{action.action}{outcome} {action.predicted_s:.2f} → {action.actual_s:.2f}"


def _changes(run: ComparedRun) -> list[str]:
    """Chosen subgoals without repetitions."""
    return _distinct([", ".join(f"{name} {value:z.2f}" for name, value in chosen(s).items()) for s in run.subgoals])


def _steps(plan: PlanReport) -> str:
    """Steps of a plan in VHPOP's form, in the order of the plan, or the reason why there is none."""
    steps = re.findall(r"^Step \d+\s*: (\(.*\))", plan.plan, flags=re.MULTILINE)
    return " ".join(steps) or (
        f"{plan.status}: {reason_text(plan.reason, plan.detail)}" if plan.reason else "nothing left to do"
    )


def _distinct(texts: list[str]) -> list[str]:
    """Texts without empty ones and without consecutive repetitions."""
    return [text for text, before in zip(texts, ["", *texts], strict=False) if text and text != before]


def _side_by_side(title: str, a: ComparedRun, b: ComparedRun, left: list[str], right: list[str]) -> Table:
    table = Table(title=title, title_justify="left", box=None, show_lines=False)
    table.add_column(plain(a.name), ratio=1)
    table.add_column(plain(b.name), ratio=1)
    for row in zip_longest(left, right, fillvalue=""):
        table.add_row(*map(plain, row))
    return table
