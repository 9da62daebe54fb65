"""Whether episodes in lock-step are like live ones: the same starts over the bus, in real processes and real time.

Evaluations run in lock-step, because that is faster than time. A sample of live runs shows that nothing hangs on it.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.progress import track

from executive import domains
from executive.composition import Order
from executive.core.context import Settings
from executive.refinement.settings import RefinementSettings
from runtime.recording import open_recording
from runtime.stopping import Stop, stop_on_signals
from schemas.errors import Rejected, UsageError
from schemas.messages import Message
from tools.evaluations.equivalence import equivalence
from tools.evaluations.heard import Unseen, episode_of
from tools.evaluations.journal import Journal
from tools.evaluations.live_plot import draw_agreement
from tools.evaluations.outcome import Outcome, Task, Variant, outcome_of
from tools.evaluations.report import Report, configure_report, tell
from tools.evaluations.trials import made_of, run_all
from tools.evaluations.watched import FIRST_SEED
from tools.system import Plan, free_endpoint, run_system

OTHER_NOISE = 500_000  # the same starts in lock-step with this noise: how far apart luck alone puts episodes
MARGIN_PCT = 5.0  # of the mean duration, fixed before the first run: half of what refinement gains
LOCKSTEP, LUCK, LIVE = "lock-step", "lock-step, other noise", "live"
REMARKS = (
    "each row against lock-step from the same starts; live has noise of its own, delays on the bus, and a budget in "
    "time instead of checks",
    f"equivalent: both one-sided t-tests (TOST, p_equivalent) say at 5 % that the means are less than {MARGIN_PCT:g} % "
    "apart; the second row shows how far luck alone puts the same starts apart",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate live`."""
    parser.add_argument("--episodes", type=int, default=20, help="starts (default %(default)s, about 20 s each)")
    parser.add_argument("--scenario", default="approach-dribble", help="of soccer's (default %(default)s)")
    parser.add_argument(
        "--horizon", type=int, default=2, help="actions looked ahead; 1 is greedy (default %(default)s)"
    )
    parser.add_argument("--recordings", type=Path, metavar="DIR", help="keep the recordings of the runs there")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run, compare and tell; 0 when live runs end alike and take equally long, 130 when stopped."""
    if arguments.episodes < 2:
        raise UsageError(f"--episodes is {arguments.episodes}, expected at least 2")
    task = Task("soccer", arguments.scenario, "", arguments.zoo)
    seeds = range(FIRST_SEED, FIRST_SEED + arguments.episodes)
    found = _lockstep(task, arguments, seeds)
    stop = stop_on_signals()
    found[LIVE] = _live(task, arguments, seeds, stop)
    if stop.requested:
        return 130
    rows = [_row(name, arguments.horizon, found[LOCKSTEP], found[name]) for name in (LIVE, LUCK)]
    plots = {}
    if arguments.report is not None:
        path = arguments.report / "live.png"
        apart = {name: _durations(found[LOCKSTEP], found[name]) for name in (LIVE, LUCK)}
        plots["live and lock-step durations"] = draw_agreement(apart, rows[0]["margin_s"], path)
    title = f"Live over the bus against lock-step: {arguments.scenario}"
    tell(Report("live", title, rows, REMARKS, plots), arguments.json, arguments.report)
    return 0 if rows[0]["equivalent"] and rows[0]["same_result_pct"] == 100 else 1


def _lockstep(task: Task, arguments: argparse.Namespace, seeds: Sequence[int]) -> dict[str, dict[int, Outcome]]:
    refinement = replace(RefinementSettings(), horizon=arguments.horizon)
    variants = [Variant(LOCKSTEP, refinement), Variant(LUCK, refinement, noise=OTHER_NOISE)]
    return run_all(task, variants, seeds, arguments.jobs, arguments.store, "lock-step")


def _live(task: Task, arguments: argparse.Namespace, seeds: Sequence[int], stop: Stop) -> dict[int, Outcome]:
    """The live outcomes by seed; those of earlier runs are taken from the store."""
    refinement = replace(RefinementSettings(), horizon=arguments.horizon)
    journal = Journal(arguments.store, task, Variant(LIVE, refinement), made_of(task))
    missing = [seed for seed in seeds if seed not in journal.known]
    for seed in track(missing, "live", transient=True):
        order = Order(task.domain, task.scenario, Settings(seed=seed, refinement=refinement), task.zoo)
        outcome = run_live(order, stop, arguments.recordings)
        if stop.requested:
            break
        journal.note(outcome)
        journal.known[seed] = outcome
    return {seed: journal.known[seed] for seed in seeds if seed in journal.known}


def run_live(order: Order, stop: Stop, keep: Path | None = None) -> Outcome:
    """One whole system from start to goal over a bus of its own, and what came of it, from its recording alone.

    Args:
      order: What the executive runs; its seed is that of the world too.
      stop: Ends the run early when requested.
      keep: Folder for the recording; None throws it away.
    """
    seed = order.settings.seed
    with tempfile.TemporaryDirectory() as folder:
        kept = Path(folder) if keep is None else keep
        kept.mkdir(parents=True, exist_ok=True)
        recording = kept / f"{order.scenario}-h{order.settings.refinement.horizon}-{seed}.mcap"
        recording.unlink(missing_ok=True)
        unseen = Unseen()
        result = run_system(Plan(order, free_endpoint(), recording, once=True), unseen, stop)
        episode = episode_of(_messages(recording), result or "failed: stopped")
    return outcome_of(episode, domains.load(order.domain), LIVE, seed)


def _messages(recording: Path) -> list[Message]:
    if not recording.exists():
        return []
    return [message for _, message in open_recording(recording).decoded() if not isinstance(message, Rejected)]


def _row(name: str, horizon: int, lockstep: Mapping[int, Outcome], these: Mapping[int, Outcome]) -> dict[str, Any]:
    first_s, second_s = _durations(lockstep, these)
    said = equivalence(first_s, second_s, MARGIN_PCT / 100 * float(np.mean(first_s)))
    seeds = sorted(these)
    return {
        "run": name,
        "horizon": horizon,
        "n": len(first_s),
        "mean_lockstep_s": float(np.mean(first_s)),
        "mean_s": float(np.mean(second_s)),
        "difference_s": said.difference,
        "ci95_s": said.ci95,
        "p_value": said.p_different,
        "margin_s": said.margin,
        "p_equivalent": said.p_equivalent,
        "equivalent": said.p_equivalent < 0.05,
        "apart_s": float(np.mean(np.abs(np.subtract(second_s, first_s)))),
        "same_result_pct": _share([these[s].achieved == lockstep[s].achieved for s in seeds]),
        "same_actions_pct": _share([these[s].actions == lockstep[s].actions for s in seeds]),
        "failed": sum(not these[s].achieved for s in seeds),
    }


def _durations(first: Mapping[int, Outcome], second: Mapping[int, Outcome]) -> tuple[list[float], list[float]]:
    """Durations of the episodes that reached their goal in both."""
    both = [seed for seed in sorted(second) if first[seed].achieved and second[seed].achieved]
    return [first[seed].duration_s for seed in both], [second[seed].duration_s for seed in both]


def _share(flags: Sequence[bool]) -> float:
    return 100 * float(np.mean(flags))
