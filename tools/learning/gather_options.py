"""Options of `tailor gather`, and which of them go together."""

from __future__ import annotations

import argparse
from pathlib import Path

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least, processes
from tailor.tools.parallel.cluster import configure_cluster

EPILOG = """\
examples:
  tailor gather agilo goToPose dribbleBall --episodes 1000 --jobs 2 --seed 7 --out data/agilo
  tailor gather agilo goToPose --episodes 1000 --jobs 2 --seed 7 --out data/agilo --resume   (after Ctrl-C)
  tailor gather agilo goToPose --beside-object --episodes 3000 --seed 8 --out data/agilo-beside
  tailor gather agilo goToPose --beside-objects 20 --episodes 1400 --seed 31 --out data/agilo-objects
  tailor gather agilo --on-policy approach-dribble waypoints --episodes 160 --out data/agilo-policy
  tailor gather agilo --on-policy approach-dribble --horizon 1 --episodes 200 --seed 8 --out data/agilo-greedy
  tailor gather agilo --on-policy approach-dribble --episodes 300 --seed 9 --calibrates --out data/agilo-intervals
  tailor gather agilo --active approach-dribble waypoints --episodes 300 --out data/agilo-active
  tailor gather agilo approachBall --uncertain --episodes 300 --out data/agilo-uncertain
  tailor gather agilo --episodes 30000 --on tcp://lab-7:8786 --out data/agilo   (on a cluster: docs/cluster.md)
  tailor gather agilo --profile degraded --out data/agilo-degraded   (a worse camera, other tyres)
  tailor gather agilo --from monday.mcap tuesday.mcap --out data/agilo-real

The episodes of each action are written to OUT/ACTION: Parquet parts, and manifest.json with their provenance. The same
seed gives the same bits for any number of jobs, here and on a cluster."""
HORIZON = RefinementSettings().horizon  # of the choices of --on-policy
POOL = 4  # situations per episode of --active
UNCERTAIN_POOL = 30  # tasks drawn per episode of --uncertain
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
        "--horizon",
        type=at_least(1, "--horizon"),
        help=f"--on-policy: actions that are optimised together (default: {HORIZON}; 1: greedy choices)",
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


def refuse_ignored(arguments: argparse.Namespace) -> None:
    """Raise UsageError for flags that are without effect beside the others."""
    if arguments.pool is not None and not (arguments.active or arguments.uncertain):
        raise UsageError("--pool counts the situations of --active and tasks of --uncertain, expected none without")
    if arguments.zoo and not (arguments.active or arguments.on_policy or arguments.uncertain):
        raise UsageError(f"--zoo names the models that choose, expected none without {CHOOSING}")
    if arguments.horizon is not None and not arguments.on_policy:
        raise UsageError("--horizon is for choices that are executed, expected none without --on-policy")
    if arguments.calibrates and not arguments.on_policy:
        raise UsageError("--calibrates is for choices of finished models, expected none without --on-policy")
    for name, default in SIMULATED.items() if arguments.recordings else ():
        if getattr(arguments, name) != default:
            raise UsageError(f"--{name} is for simulated runs, expected none with --from")
