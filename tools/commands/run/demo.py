"""Execute the same plan twice from the same seed, greedy and refined, and show both runs in step on one page."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import UsageError
from tailor.tools.cli.live_status import screen
from tailor.tools.cli.output_files import whole_output
from tailor.tools.cli.systems.deployment import Deployment, executive_config
from tailor.tools.figures.recorded_track import recorded_track
from tailor.tools.figures.track import Track
from tailor.tools.launch.hosting import private_bus
from tailor.tools.launch.processes import LaunchConfig
from tailor.tools.launch.system import run_system
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.recorded_events import recorded_events
from tailor.tools.viewer.side_by_side import side_by_side
from tailor.tools.viewer.timeline import RunTimeline

RUNS = (("greedy", 1), ("refined", 2))  # the paper's h


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor demo`."""
    parser.add_argument("--scenario", default="approach-dribble", help="a soccer scenario (default %(default)s)")
    parser.add_argument(
        "--seed", type=int, default=1, help="random seed of start, ball, target and noise (default %(default)s)"
    )
    parser.add_argument("--json", action="store_true", help="print the results of both runs as JSON at the end")
    parser.add_argument("--output", type=Path, default=Path("out/demo"), help="output folder (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Run both and write recordings, page and picture; 0 if both runs reached the goal."""
    if arguments.seed < 0:
        raise UsageError(f"--seed is {arguments.seed}, expected at least 0")
    config = executive_config("soccer", Deployment(scenario=arguments.scenario))
    build_context(config, sender="")  # reports what is wrong with it before the recordings of before are removed
    stop = stop_on_signals()
    folder: Path = arguments.output
    folder.mkdir(parents=True, exist_ok=True)
    tracks = []
    for name, horizon in RUNS:
        recording = folder / f"{name}.mcap"
        recording.unlink(missing_ok=True)
        _run_once(config, arguments, (name, horizon), recording, stop)
        if stop.requested:
            return stop.exit_code
        tracks.append(recorded_track(f"{name} (h = {horizon})", recording))
    _write(tracks, folder)
    if arguments.json:
        print(json.dumps([_row(track) for track in tracks]))
    else:
        console = Console(highlight=False, markup=False, soft_wrap=True)
        console.print(summary(tracks))
        console.print("\n".join(next_lines(folder)))
    return 0 if all(track.result == "achieved" for track in tracks) else 1


def _row(track: Track) -> dict[str, Any]:
    return {
        "run": track.title,
        "result": track.result,
        "actual_s": round(track.actual_s, 3),
        "predicted_s": round(track.predicted_s, 3),
        "missed_ticks": track.missed_ticks,
    }


def _write(tracks: Sequence[Track], folder: Path) -> None:
    """The page of both runs, and the paper's kind of picture."""
    from tailor.tools.figures.paths import draw_paths

    with whole_output(folder / "paths.png") as picture:
        draw_paths(list(tracks), picture)
    runs = {
        track.title: recorded_events(folder / f"{name}.mcap", RunTimeline(Explainer()))
        for track, (name, _) in zip(tracks, RUNS, strict=True)
    }
    page = side_by_side("The same plan, executed twice", gain(tracks), runs)
    with whole_output(folder / "index.html") as whole:
        whole.write_text(page, encoding="utf-8")


def next_lines(folder: Path) -> list[str]:
    """What was written, and what to try next."""
    refined = folder / "refined.mcap"
    tailor = "tailor" if shutil.which("tailor") else sys.argv[0]  # after `make demo` no environment is active
    return [
        f"both runs in step: {(folder / 'index.html').resolve().as_uri()}",
        f"also written: {folder}/greedy.mcap, {refined}, {folder}/paths.png",
        f"next: {tailor} why {refined}          # why each subgoal was chosen",
        f"next: {tailor} verify {refined}       # the recording through the core again, compared bit for bit",
        f"next: {tailor} up soccer --seed 2      # a whole system; `{tailor} view --live` shows it in a browser",
        f"next: {tailor} letters                 # the same executive writes with an arm",
    ]


def _run_once(
    config: ExecutiveConfig, arguments: argparse.Namespace, mode: tuple[str, int], recording: Path, stop: Stop
) -> None:
    (name, horizon), settings = mode, config.settings
    refinement = replace(settings.refinement, horizon=horizon)
    config = replace(config, settings=replace(settings, seed=arguments.seed, refinement=refinement))
    with screen(quiet=arguments.json) as shown:
        shown.report(f"{name}: h = {horizon}, scenario {arguments.scenario}, seed {arguments.seed}")
        result = run_system(LaunchConfig(config, private_bus(), recording, once=True), shown, stop)
        shown.report(f"{name}: {result or 'stopped'}")


def summary(tracks: Sequence[Track]) -> Table:
    """Table of predicted and actual durations, with late and missed ticks."""
    table = Table(title="The same plan, executed twice")
    for column in ("", "action", "predicted", "actual"):
        table.add_column(column, justify="left" if column in ("", "action") else "right")
    for track in tracks:
        for index, action in enumerate(track.finished):
            table.add_row(
                track.title if index == 0 else "",
                f"{action.action} ({action.outcome})",
                f"{action.predicted_s:.2f} s",
                f"{action.actual_s:.2f} s",
            )
        table.add_row("", "sum", f"{track.predicted_s:.2f} s", f"{track.actual_s:.2f} s", style="bold")
        timing = f"{track.ticks} ticks, {track.late_ticks} late by over 50 ms, {track.missed_ticks} missed"
        table.add_row("", timing, "", "", end_section=True)
    table.caption = gain(tracks)
    return table


def gain(tracks: Sequence[Track]) -> str:
    """The first run's duration against the last one's, in words; empty if the first did nothing."""
    greedy_s, refined_s = tracks[0].actual_s, tracks[-1].actual_s
    if greedy_s <= 0:
        return ""
    return f"greedy {greedy_s:.2f} s, refined {refined_s:.2f} s: {100 * (1 - refined_s / greedy_s):.1f} % less time"
