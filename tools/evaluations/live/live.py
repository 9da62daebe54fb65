"""Agreement of live runs with lock-step: the same starts over the bus, in real processes and real time.

Evaluations run in lock-step, which is faster than real time. A sample of live runs validates them.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig
from tailor.executive.deliberation.context import Settings
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.tools.cli.number_checks import add_count
from tailor.tools.evaluations.dependencies import OVER_BUS, dependencies
from tailor.tools.evaluations.journal import Journal
from tailor.tools.evaluations.live.agreement import agreement, starts_of, with_thresholds
from tailor.tools.evaluations.live.bus_run import NullScreen, run_of
from tailor.tools.evaluations.live.live_plot import draw_agreement
from tailor.tools.evaluations.outcome import OTHER_NOISE, Outcome, Task, Variant, outcome_of
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.task_runs import run_all
from tailor.tools.launch.hosting import private_bus
from tailor.tools.launch.processes import LaunchConfig
from tailor.tools.launch.system import run_system

MARGIN_PCT = 5.0  # fixed before the first run: half of the improvement by refinement
LIVE, REPEATED = "live", "lock-step, repeated"
Runs = Mapping[int, Outcome]  # by seed
Repeats = Mapping[int, Sequence[Outcome]]
REMARKS = (
    "Each run against the lock-step runs of the same start, which differ only by their noise. The second row is one "
    "more lock-step run of each start: the reference of perfect agreement with so few starts.",
    "difference, 95 % interval, p value: of the geometric means, paired; p rank: whether the ranks of the runs among "
    "their start's lock-step runs are uniform; within range: runs between the shortest and longest of their start.",
    f"equivalent: both one-sided t-tests (TOST) reject at 5 % a difference of the means of {MARGIN_PCT:g} % or more.",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate live`."""
    add_count(parser, "--episodes", 2, 20, "starts, about 20 s each")
    parser.add_argument("--scenario", default="approach-dribble", help="soccer scenario (default %(default)s)")
    add_count(parser, "--horizon", 1, 2, "horizon of refinement; 1 is greedy")
    add_count(parser, "--repeats", 2, 15, "lock-step runs of each start")
    parser.add_argument("--recordings", type=Path, metavar="DIR", help="keep the recordings of the runs in DIR")
    configure_report(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run, compare and publish the report.

    Returns:
      0 if live runs end like those in lock-step and neither test finds a difference, else 1; 130 after Ctrl-C, 143
      after SIGTERM.
    """
    task = Task("soccer", arguments.scenario, "", arguments.zoo)
    seeds = seeds_of(task.domain, arguments)
    starts = seeds.starts(arguments.episodes)
    repeats = _lockstep(task, arguments, starts)
    repeated = {seed: some.pop() for seed, some in repeats.items()}
    stop = stop_on_signals()
    found = {LIVE: _live(task, arguments, starts, stop), REPEATED: repeated}
    if stop.requested:
        return stop.exit_code
    rows = [_row(name, arguments.horizon, runs, repeats) for name, runs in found.items()]
    plots = {}
    if arguments.report is not None:
        pairs = {name: starts_of(runs, repeats) for name, runs in found.items()}
        plots["durations and differences"] = draw_agreement(pairs, MARGIN_PCT, arguments.report / "live.png")
    title = f"Live over the bus against lock-step: {arguments.scenario}"
    shown = [with_thresholds(row) for row in rows]
    publish_report(Report("live", title, shown, REMARKS, plots, seeds.provenance), arguments)
    live = rows[0]
    alike = min(live["p_value"], live["p_rank"]) > 0.05
    return 0 if alike and live["achieved_pct"] >= live["achieved_lockstep_pct"] - 5 else 1


def _lockstep(task: Task, arguments: argparse.Namespace, seeds: Sequence[int]) -> dict[int, list[Outcome]]:
    """Lock-step runs of every start, one more than requested."""
    refinement = replace(RefinementSettings(), horizon=arguments.horizon)
    variants = [Variant(f"noise-{k}", refinement, noise=k * OTHER_NOISE) for k in range(arguments.repeats + 1)]
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, "lock-step")
    return {seed: [found[variant.name][seed] for variant in variants] for seed in seeds}


def _live(task: Task, arguments: argparse.Namespace, seeds: Sequence[int], stop: Stop) -> dict[int, Outcome]:
    """Live outcomes by seed; stored ones are reused."""
    refinement = replace(RefinementSettings(), horizon=arguments.horizon)
    variant = Variant(LIVE, refinement)
    journal = Journal(arguments.store, task, variant, dependencies(task, variant, OVER_BUS))
    missing = [seed for seed in seeds if seed not in journal.known]
    for seed in tracked(missing, "live"):
        config = ExecutiveConfig(task.domain, task.scenario, Settings(seed=seed, refinement=refinement), task.zoo)
        outcome = run_live(config, stop, arguments.recordings)
        if stop.requested:
            break
        journal.note(outcome)
        journal.known[seed] = outcome
    return {seed: journal.known[seed] for seed in seeds if seed in journal.known}


def run_live(config: ExecutiveConfig, stop: Stop, keep: Path | None = None) -> Outcome:
    """Run a whole system over a bus of its own; the outcome is read from its recording.

    Args:
      config: Configuration of the executive; its seed is also that of the world.
      stop: Ends the run early when requested.
      keep: Folder for the recording; None deletes it.
    """
    seed = config.settings.seed
    with tempfile.TemporaryDirectory() as folder:
        kept = Path(folder) if keep is None else keep
        kept.mkdir(parents=True, exist_ok=True)
        recording = kept / f"{config.scenario}-h{config.settings.refinement.horizon}-{seed}.mcap"
        recording.unlink(missing_ok=True)
        result = run_system(LaunchConfig(config, private_bus(), recording, once=True), NullScreen(), stop)
        run = run_of(_messages(recording), result or "failed: stopped")
    return outcome_of(run, domains.load(config.domain), LIVE, seed)


def _messages(recording: Path) -> list[tuple[str, Message]]:
    if not recording.exists():
        return []
    decoded = open_recording(recording).decoded()
    return [(recorded.key, message) for recorded, message in decoded if not isinstance(message, Rejected)]


def _row(name: str, horizon: int, runs: Runs, repeats: Repeats) -> dict[str, Any]:
    seeds = sorted(runs)
    failures = sorted({runs[seed].result for seed in seeds if not runs[seed].achieved})
    usual = [{outcome.actions for outcome in repeats[seed]} for seed in seeds]
    return {
        "run": name,
        "horizon": horizon,
        **agreement(starts_of(runs, repeats), MARGIN_PCT),
        "achieved_pct": _share([runs[seed].achieved for seed in seeds]),
        "achieved_lockstep_pct": _share([outcome.achieved for seed in seeds for outcome in repeats[seed]]),
        "same_actions_pct": _share([runs[seed].actions in some for seed, some in zip(seeds, usual, strict=True)]),
        "failures": "; ".join(failures),
    }


def _share(flags: Sequence[bool]) -> float:
    return 100 * float(np.mean(flags))
