"""Action models of any domain on fresh episodes, with random arguments and with those that the executive chooses.

Intervals that hold on random arguments may hold less where the optimiser goes, so both are measured. The paper's Tables
1 and 2 are this evaluation, on random arguments, with the paper's figures beside ours.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from tailor.executive import domains
from tailor.models.episodes.episodes import read_data_set
from tailor.models.episodes.sources import RUN_NUMBERS
from tailor.models.runtime import load_robot
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.tools.cli.number_checks import at_least
from tailor.tools.evaluations.models import fresh, model_rows
from tailor.tools.evaluations.models.model_rows import Row
from tailor.tools.evaluations.progress import tracked
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.learning.gathering.run_data_sets import modelled_actions

RUNS = 400  # of each scenario of --on-policy
REMARKS = (
    *model_rows.REMARKS,
    "chosen in: fresh runs of the executive in that scenario with these models; empty: random arguments",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor evaluate models`."""
    add = parser.add_argument
    model_rows.configure(parser)
    add("--on-policy", nargs="+", default=[], metavar="SCENARIO", help="also test on the executive's choices in these")
    add("--runs", type=at_least(1, "--runs"), help=f"runs of each of these (default {RUNS})")


def run(arguments: argparse.Namespace) -> int:
    """Evaluate and publish the report; exit code 0."""
    if not arguments.domain:
        raise UsageError("no domain named, expected --domain NAME")
    if arguments.runs and not arguments.on_policy:
        raise UsageError("--runs counts those of --on-policy, expected none without it")
    domain, known = arguments.domain, domains.scenarios(arguments.domain)
    for name in arguments.on_policy:
        if name not in known:
            raise UsageError(f"--on-policy {name}: no such scenario of {domain}, expected some of {', '.join(known)}")
    made = [{**row, "chosen_in": ""} for row in model_rows.rows(domain, arguments)]
    made += _chosen_rows(domain, arguments)
    model_rows.publish("models", f"Action models: {domain}", made, REMARKS, arguments)
    return 0


def _chosen_rows(domain: str, arguments: argparse.Namespace) -> list[Row]:
    """A row for each scenario and each action that its runs finish."""
    if not arguments.on_policy:
        return []
    robot = domains.load(domain).robot
    durations, _ = load_robot(robot, Path(arguments.zoo) if arguments.zoo else models_folder(robot))
    first = seeds_of(domain, arguments).first
    seed, where = fresh.run_seed(first), (arguments.zoo, arguments.jobs, arguments.store)
    rows = []
    for scenario in tracked(arguments.on_policy, "scenarios"):
        folder = fresh.chosen(robot, (scenario,), arguments.runs or RUNS, seed, *where)
        for action in modelled_actions(domain):
            data = read_data_set(folder / action)
            if any(episode.finished for episode in data.episodes):
                columns = model_rows.duration_columns(durations, f"{action}/duration", data, first, RUN_NUMBERS)
                rows.append({"domain": domain, "action": action, "chosen_in": scenario, **columns})
    return rows
