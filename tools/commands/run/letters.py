"""Write capital letters with the arm, stopping at every waypoint and with refined velocities; tabulate and draw."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.letters import MAX_LETTERS, is_word
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import JointState
from tailor.tools.cli.live_status import screen
from tailor.tools.cli.systems.deployment import Deployment, executive_config
from tailor.tools.launch.hosting import private_bus
from tailor.tools.launch.processes import LaunchConfig
from tailor.tools.launch.system import run_system
from tailor.tools.writing.measures import roughness, waypoint_errors_rad
from tailor.tools.writing.writing_mode import WritingMode
from tailor.tools.writing.writing_track import WritingTrack, writing_track

REFINED = RefinementSettings()
MODES = (
    WritingMode("stopping", REFINED, stops=True),
    WritingMode("greedy", replace(REFINED, horizon=1)),
    WritingMode("refined", REFINED),
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor letters`."""
    parser.add_argument("text", nargs="?", default="TAILOR", help="text in capital letters (default %(default)s)")
    parser.add_argument(
        "--seed", type=int, default=1, help="random seed of size, start and noise (default %(default)s)"
    )
    parser.add_argument(
        "--greedy", action="store_true", help="also write with velocities that are optimal for each reach alone"
    )
    parser.add_argument(
        "--lockstep", action="store_true", help="run without the bus, as fast as possible; nothing is recorded"
    )
    parser.add_argument("--json", action="store_true", help="print the row of each mode as JSON at the end")
    parser.add_argument("--output", type=Path, default=Path("out/letters"), help="output folder (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Write in every mode, print the table and draw; 0 if every mode reached the last waypoint."""
    text = arguments.text.upper()
    if not is_word(text):
        raise UsageError(f"cannot write {arguments.text!r}, expected 1 to {MAX_LETTERS} of the letters A to Z")
    if arguments.seed < 0:
        raise UsageError(f"--seed is {arguments.seed}, expected at least 0")
    modes = [mode for mode in MODES if arguments.greedy or mode.name != "greedy"]
    arguments.output.mkdir(parents=True, exist_ok=True)
    if arguments.lockstep:
        tracks = _in_lockstep(text, modes, arguments.seed)
    else:
        tracks = _live(text, modes, arguments, stop := stop_on_signals())
        if stop.requested:
            return stop.exit_code
    if nothing := [track for track in tracks if not track.duration_s]:
        print(*(f"{each.title}: no waypoint was reached: {each.result or 'stopped'}" for each in nothing), sep="\n",
              file=sys.stderr)  # fmt: skip
        return 1
    pictures = _draw(tracks, arguments.output)
    if arguments.json:
        print(json.dumps([_row(track) for track in tracks]))
    else:
        console = Console()
        console.print(summary(tracks))
        console.print(*pictures, highlight=False)
    return 0 if all(track.result == "achieved" for track in tracks) else 1


def summary(tracks: Sequence[WritingTrack]) -> Table:
    """Table of duration, waypoint error, peak current and roughness of each mode."""
    table = Table(title=f"{tracks[0].text} by the arm")
    for column in ("mode", "took", "predicted", "worst waypoint", "current", "roughness", "result"):
        table.add_column(column, justify="left" if column in ("mode", "result") else "right")
    for track in tracks:
        row = _row(track)
        table.add_row(
            row["mode"],
            f"{row['took_s']:.1f} s",
            f"{row['predicted_s']:.1f} s",
            f"{1e3 * row['worst_waypoint_rad']:.1f} mrad",
            f"{row['peak_current_a']:.1f} A",
            f"{row['roughness']:.1f}",
            row["result"],
        )
    gain = 100 * (1 - tracks[-1].duration_s / tracks[0].duration_s)
    table.caption = f"{tracks[-1].title} against {tracks[0].title}: {gain:.1f} % faster"
    return table


def _row(track: WritingTrack) -> dict[str, Any]:
    return {
        "mode": track.title,
        "took_s": float(track.duration_s),
        "predicted_s": float(track.predicted_s.sum() + PERIOD_S * len(track.predicted_s)),
        "worst_waypoint_rad": float(waypoint_errors_rad(track).max()),
        "peak_current_a": float(track.peak_current_a),
        "roughness": float(roughness(track)),
        "result": track.result,
    }


def _in_lockstep(text: str, modes: Sequence[WritingMode], seed: int) -> list[WritingTrack]:
    from tailor.executive.interfaces.models import Models
    from tailor.models.runtime import load_robot
    from tailor.tools.writing.writing_run import RecordedBody, write  # here: they load the simulator

    models, body = Models(*load_robot(RecordedBody.robot)), RecordedBody()
    return [write(text, mode, models, seed, body)[0] for mode in modes]


def _live(text: str, modes: Sequence[WritingMode], arguments: argparse.Namespace, stop: Stop) -> list[WritingTrack]:
    """Tracks of the modes that ran before a stop."""
    tracks = []
    for mode in modes:
        recording = arguments.output / f"{text}-{mode.name}.mcap"
        recording.unlink(missing_ok=True)
        _run_once(text, mode, arguments, recording, stop)
        if stop.requested:
            break
        tracks.append(recorded_track(mode.name, text, recording))
    return tracks


def _run_once(text: str, mode: WritingMode, arguments: argparse.Namespace, recording: Path, stop: Stop) -> None:
    scenario = f"{'stops' if mode.stops else 'word'}-{text}"
    config = executive_config("arm", Deployment(scenario=scenario))
    config = replace(config, settings=replace(config.settings, seed=arguments.seed, refinement=mode.refinement))
    with screen(quiet=arguments.json) as shown:
        shown.report(f"{mode.name}: {text}, seed {arguments.seed}")
        run_system(LaunchConfig(config, private_bus(), recording, once=True), shown, stop)


def recorded_track(title: str, text: str, path: Path) -> WritingTrack:
    """Track of the letters in a recording; raises UsageError if the file is not a recording."""
    kept = []
    for recorded, message in open_recording(path).decoded():
        truth = isinstance(message, JointState) and not recorded.key.endswith("/joint_states")
        if not isinstance(message, Rejected) and not truth:
            kept.append(message)
    return writing_track(title, text, kept)


def _draw(tracks: Sequence[WritingTrack], folder: Path) -> list[str]:
    """Draw in joint space, as in the paper's Figure 13 (b), and at the scale of the page."""
    from tailor.tools.figures.letters import draw_words

    joints, page = folder / f"{tracks[0].text}-joints.png", folder / f"{tracks[0].text}-page.png"
    draw_words(tracks, joints, in_joints=True)
    draw_words(tracks, page)
    return [str(joints), str(page)]
