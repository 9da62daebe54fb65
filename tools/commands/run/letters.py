"""Write capitals with the arm, stopping at every waypoint and with refined velocities: tabulated, and drawn."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tailor.executive.domains.arm.letters import MAX_LETTERS, is_word
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import JointState
from tailor.tools.cli.deployment import Deployment, order_of
from tailor.tools.cli.live_status import screen
from tailor.tools.figures.letters import draw_words
from tailor.tools.launch.system import LaunchConfig, free_endpoint, run_system
from tailor.tools.writing.measures import roughness, waypoint_errors_rad
from tailor.tools.writing.writing_run import RecordedBody, WritingMode, write
from tailor.tools.writing.writing_track import PERIOD_S, WritingTrack, writing_track

REFINED = RefinementSettings()
HANDS = (
    WritingMode("stopping", REFINED, stops=True),
    WritingMode("greedy", replace(REFINED, horizon=1)),
    WritingMode("refined", REFINED),
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor letters`."""
    parser.add_argument("text", nargs="?", default="TAILOR", help="capitals (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of size, start and noise (default %(default)s)")
    parser.add_argument("--greedy", action="store_true", help="also with velocities that suit each reach alone")
    parser.add_argument("--lockstep", action="store_true", help="without the bus, as fast as it goes; nothing recorded")
    parser.add_argument("--output", type=Path, default=Path("out/letters"), help="folder (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Write by every hand, show the table, draw; 0 when all reached the last waypoint."""
    text = arguments.text.upper()
    if not is_word(text):
        raise UsageError(f"cannot write {arguments.text!r}, expected 1 to {MAX_LETTERS} of the letters A to Z")
    if arguments.seed < 0:
        raise UsageError(f"--seed is {arguments.seed}, expected at least 0")
    hands = [hand for hand in HANDS if arguments.greedy or hand.name != "greedy"]
    arguments.output.mkdir(parents=True, exist_ok=True)
    if arguments.lockstep:
        rows = _in_lockstep(text, hands, arguments.seed)
    else:
        rows = _live(text, hands, arguments.seed, arguments.output)
    if len(rows) < len(hands):
        return 130
    console = Console()
    console.print(summary(rows))
    console.print(*_draw(rows, arguments.output), highlight=False)
    return 0 if all(said.result == "achieved" for said in rows) else 1


def summary(rows: Sequence[WritingTrack]) -> Table:
    """How long each hand took, how well it kept to the waypoints, and how smooth it was."""
    table = Table(title=f"{rows[0].text} by the arm")
    for column in ("hand", "took", "predicted", "worst waypoint", "current", "roughness", "result"):
        table.add_column(column, justify="left" if column in ("hand", "result") else "right")
    for said in rows:
        table.add_row(
            said.title,
            f"{said.duration_s:.1f} s",
            f"{said.predicted_s.sum() + PERIOD_S * len(said.predicted_s):.1f} s",
            f"{1e3 * waypoint_errors_rad(said).max():.1f} mrad",
            f"{said.peak_current_a:.1f} A",
            f"{roughness(said):.1f}",
            said.result,
        )
    gain = 100 * (1 - rows[-1].duration_s / rows[0].duration_s)
    table.caption = f"{rows[-1].title} against {rows[0].title}: {gain:.1f} % faster"
    return table


def _in_lockstep(text: str, hands: Sequence[WritingMode], seed: int) -> list[WritingTrack]:
    from tailor.executive.interfaces.models import Models
    from tailor.models.runtime import load_robot

    models, body = Models(*load_robot(RecordedBody.robot)), RecordedBody()
    return [write(text, hand, models, seed, body) for hand in hands]


def _live(text: str, hands: Sequence[WritingMode], seed: int, folder: Path) -> list[WritingTrack]:
    """As many as were not interrupted."""
    stop, rows = stop_on_signals(), []
    for hand in hands:
        recording = folder / f"{text}-{hand.name}.mcap"
        recording.unlink(missing_ok=True)
        _run_once(text, hand, seed, recording, stop)
        if stop.requested:
            break
        rows.append(recorded(hand.name, text, recording))
    return rows


def _run_once(text: str, hand: WritingMode, seed: int, recording: Path, stop: Stop) -> None:
    scenario = f"{'stops' if hand.stops else 'word'}-{text}"
    order = order_of("arm", Deployment(scenario=scenario))
    order = replace(order, settings=replace(order.settings, seed=seed, refinement=hand.refinement))
    with screen() as shown:
        shown.tell(f"{hand.name}: {text}, seed {seed}")
        run_system(LaunchConfig(order, free_endpoint(), recording, once=True), shown, stop)


def recorded(title: str, text: str, path: Path) -> WritingTrack:
    """What a recording says was written; raises UsageError if it is none."""
    kept = []
    for line, message in open_recording(path).decoded():
        truth = isinstance(message, JointState) and not line.key.endswith("/joint_states")
        if not isinstance(message, Rejected) and not truth:
            kept.append(message)
    return writing_track(title, text, kept)


def _draw(rows: Sequence[WritingTrack], folder: Path) -> list[str]:
    """In joint space, as the paper's Figure 13 (b), and at the scale of the page."""
    joints, page = folder / f"{rows[0].text}-joints.png", folder / f"{rows[0].text}-page.png"
    draw_words(rows, joints, in_joints=True)
    draw_words(rows, page)
    return [str(joints), str(page)]
