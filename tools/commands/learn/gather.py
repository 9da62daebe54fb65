"""Gather training episodes: run actions with random arguments in simulation, faster than real time."""

from __future__ import annotations

import argparse
import json
from itertools import chain
from pathlib import Path

import numpy as np

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least, processes
from tailor.tools.contract.trial import try_actions
from tailor.tools.launch.checks.package_check import check_package
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.progress import gathered, note, shown
from tailor.tools.learning.recipe import UNCERTAIN_POOL
from tailor.tools.lockstep.bodies import check_profile
from tailor.tools.parallel.cluster import configure_cluster, working_on
from tailor.tools.parallel.software import Work
from tailor.tools.parallel.steps import counted

EPILOG = """\
examples:
  tailor gather agilo goToPose dribbleBall --episodes 1000 --jobs 2 --seed 7 --out data/agilo
  tailor gather agilo goToPose --episodes 1000 --jobs 2 --seed 7 --out data/agilo --resume   (after Ctrl-C)
  tailor gather agilo goToPose --beside-object --episodes 3000 --seed 8 --out data/agilo-beside
  tailor gather agilo goToPose --beside-objects 20 --episodes 1400 --seed 31 --out data/agilo-objects
  tailor gather agilo --on-policy approach-dribble waypoints --episodes 160 --out data/agilo-policy
  tailor gather agilo --on-policy approach-dribble --episodes 300 --seed 9 --calibrates --out data/agilo-intervals
  tailor gather agilo --active approach-dribble waypoints --episodes 300 --out data/agilo-active
  tailor gather agilo approachBall --uncertain --episodes 300 --out data/agilo-uncertain
  tailor gather agilo --episodes 30000 --on tcp://lab-7:8786 --out data/agilo   (on a cluster: docs/cluster.md)
  tailor gather agilo --profile degraded --out data/agilo-degraded   (a worse camera, other tyres)
  tailor gather agilo --from monday.mcap tuesday.mcap --out data/agilo-real

The episodes of each action are written to OUT/ACTION: Parquet parts, and manifest.json with their provenance. The same
seed gives the same bits for any number of jobs, here and on a cluster."""
POOL = 4  # situations per episode of --active
CHOOSING = "--on-policy, --active or --uncertain"
SIMULATED = {"episodes": 1000, "jobs": 2, "seed": 7, "profile": "", "resume": False, "on": None}  # not of recordings


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("robot", help="name of the robot, e.g. agilo")
    parser.add_argument(
        "actions", nargs="*", default=[], metavar="ACTION", help="actions to run (default: all that have a model)"
    )
    count, seed = at_least(1, "--episodes"), at_least(0, "--seed")
    parser.add_argument("--episodes", type=count, help="number per action (default: %(default)s)")
    parser.add_argument("--jobs", type=processes, help="number of processes (default: %(default)s)")
    configure_cluster(parser)
    parser.add_argument("--seed", type=seed, help="random seed (default: %(default)s)")
    parser.add_argument("--out", type=Path, help="folder for the data sets (default: data/ROBOT)")
    _configure_sources(parser)
    parser.add_argument(
        "--pool",
        type=at_least(1, "--pool"),
        help=f"--active: situations per episode (default: {POOL}); --uncertain: tasks (default: {UNCERTAIN_POOL})",
    )
    parser.add_argument(
        "--calibrates",
        action="store_true",
        help="--on-policy: the runs correct the intervals of the models that choose in them, which learn no durations "
        "from them",
    )
    parser.add_argument("--profile", help="profile of the body, e.g. degraded (default: the one that ships)")
    parser.add_argument("--zoo", default="", help=f"models for {CHOOSING} (default: the ones that ship)")
    parser.add_argument("--resume", action="store_true", help="continue an interrupted command")
    parser.add_argument("--json", action="store_true", help="print results as JSON, without progress bar")
    parser.set_defaults(**SIMULATED)


def _configure_sources(parser: argparse.ArgumentParser) -> None:
    """Declare where episodes come from, if not from random arguments."""
    other = parser.add_mutually_exclusive_group()
    other.add_argument(
        "--on-policy", nargs="+", metavar="SCENARIO", help="run scenarios with the current models instead"
    )
    other.add_argument(
        "--active",
        nargs="+",
        metavar="SCENARIO",
        help="run the refined choices on which the current models disagree most",
    )
    other.add_argument(
        "--uncertain",
        action="store_true",
        help="run the random tasks whose success the current models are least certain of: where failures are rare",
    )
    other.add_argument(
        "--from", nargs="+", type=Path, metavar="RECORDING", dest="recordings", help="extract recorded runs instead"
    )
    other.add_argument(
        "--beside-object",
        action="store_true",
        help="put one random object near each way: episodes for the action's clearance model",
    )
    other.add_argument(
        "--beside-objects",
        type=at_least(1, "--beside-objects"),
        default=0,
        metavar="N",
        help="the same with N objects noted after each way, where the controller would have ignored them",
    )


def run(arguments: argparse.Namespace) -> int:
    """Gather; exit code 0, or 130 if interrupted."""
    _refuse_ignored(arguments)
    name = random_episodes.domain_of(arguments.robot)
    check_package(name)
    check_profile(name, arguments.profile)
    out = arguments.out or Path("data") / arguments.robot
    chosen = arguments.on_policy or arguments.active or arguments.uncertain
    if arguments.on and arguments.zoo:
        arguments.zoo = str(Path(arguments.zoo).resolve())  # workers have another working directory
    with working_on(arguments.on, Work((name,), arguments.zoo if chosen else None)):
        if arguments.uncertain:
            return _uncertain(arguments, name, out)
        if chosen or arguments.recordings:
            return _from_runs(arguments, name, out)
        return _random(arguments, name, out)


def _refuse_ignored(arguments: argparse.Namespace) -> None:
    """Raise UsageError for flags that are without effect beside the others."""
    if arguments.pool is not None and not (arguments.active or arguments.uncertain):
        raise UsageError("--pool counts the situations of --active and tasks of --uncertain, expected none without")
    if arguments.zoo and not (arguments.active or arguments.on_policy or arguments.uncertain):
        raise UsageError(f"--zoo names the models that choose, expected none without {CHOOSING}")
    if arguments.calibrates and not arguments.on_policy:
        raise UsageError("--calibrates is for choices of finished models, expected none without --on-policy")
    for name, default in SIMULATED.items() if arguments.recordings else ():
        if getattr(arguments, name) != default:
            raise UsageError(f"--{name} is for simulated runs, expected none with --from")


def _random(arguments: argparse.Namespace, name: str, out: Path) -> int:
    """Gather episodes with random arguments."""
    beside = arguments.beside_object or arguments.beside_objects > 0
    actions = actions_of(name, arguments.actions, beside)
    if not beside:  # such episodes have checks of their own
        try_actions(name, actions)
    specs = [
        DataSetSpec(
            name,
            action,
            arguments.episodes,
            arguments.seed,
            out / action,
            beside=beside,
            objects=arguments.beside_objects,
            profile=arguments.profile,
        )
        for action in actions
    ]
    random_episodes.prepare_all(specs, arguments.resume)
    figures = []
    for spec in specs:
        try:
            figures.append(gathered(spec, arguments.jobs, quiet=arguments.json))
        except KeyboardInterrupt:
            kept = spec.episodes - random_episodes.missing_episodes(spec)
            note(f"{spec.folder}: kept {kept} of {spec.episodes}; --resume continues")
            return 130
    if arguments.json:
        print(json.dumps(figures))
    return 0


def _uncertain(arguments: argparse.Namespace, name: str, out: Path) -> int:
    """Gather random episodes whose success is uncertain."""
    from tailor.tools.learning.gathering.uncertain_episodes import Uncertain, judged_actions, run_uncertain

    actions = judged_actions(name, arguments.actions)
    try_actions(name, actions)
    number = (arguments.episodes, arguments.pool or UNCERTAIN_POOL, arguments.seed, arguments.zoo)
    sets = [Uncertain(name, action, *number, out / action, arguments.profile) for action in actions]
    ready = [run_uncertain(each, arguments.jobs, arguments.resume) for each in sets]
    return shown(chain.from_iterable(ready), out, arguments.json)


def _from_runs(arguments: argparse.Namespace, domain: str, out: Path) -> int:
    """Gather from recordings, or from whole runs with the current models."""
    from tailor.tools.learning.gathering import policy_runs, recorded_runs

    if arguments.actions:
        raise UsageError("whole runs take no ACTION, expected none with --from, --on-policy and --active")
    if arguments.recordings:
        extracted = recorded_runs.extract_from_recordings(domain, out, arguments.recordings)
        for line in extracted.left_out:
            note(line)
        found = ", ".join(f"{action} {count}" for action, count in extracted.counts.items())
        print(json.dumps(extracted.counts) if arguments.json else f"{out}: episodes: {found}")
        return 0
    scenarios = tuple(dict.fromkeys(arguments.on_policy or arguments.active))
    for scenario in scenarios:
        domains.load_scenario(domain, scenario, np.random.default_rng(0))  # raises UsageError if there is none
    where = (arguments.seed, arguments.zoo, out, arguments.profile)
    if arguments.active:
        from tailor.tools.learning.gathering.active_episodes import Active, run_active

        active = Active(domain, scenarios, arguments.episodes, arguments.pool or POOL, *where)
        return shown(run_active(active, arguments.jobs, arguments.resume), out, arguments.json)
    policy = policy_runs.Policy(domain, scenarios, arguments.episodes, *where, arguments.calibrates)
    running = policy_runs.run_policy(policy, arguments.jobs, arguments.resume)
    steps = counted("runs", running, len(policy.jobs), policy_runs.finished_runs(policy))
    return shown(steps, out, arguments.json)


def actions_of(domain: str, requested: list[str], beside: bool = False) -> list[str]:
    """Actions to gather: the requested ones, or all that have a duration model, or `beside` objects a context.

    Raises:
      UsageError: The domain lacks a requested action, or it has no context; or none has one.
    """
    declared = domains.load(domain).actions
    for action in requested:
        random_episodes.check_action(domain, action, beside)
    modelled = {each.duration_model.split("/")[0] for each in declared.values() if each.context or not beside}
    if not modelled:
        raise UsageError(f"no action of {domain} has a context of objects, expected one to gather beside them")
    return list(dict.fromkeys(requested)) or sorted(modelled)
