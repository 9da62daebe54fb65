"""Learn when not to refine (paper 6.3.2): a tree that predicts where refinement slows, from starts run both ways."""

from __future__ import annotations

import argparse
import dataclasses
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import at_least, finite, processes

if TYPE_CHECKING:
    from tailor.models.export.gate_publishing import GateProvenance
    from tailor.models.training.gate_training import Pairs
    from tailor.tools.evaluations.outcome import Outcome, Task

DEFAULT_SEED = 700_000
PRICE = "of improvement that fewer slower episodes may cost, in percentage points (default: %(default)s)"
EPILOG = """\
examples:
  tailor train-gate agilo
  tailor train-gate agilo --episodes 300 --zoo out/zoo

The tree judges the choices of the action models that are in the zoo now, so train it after them; `tailor train`
removes one that was learned with other models. Broken off, the same command goes on. `tailor evaluate gate` says
what the tree is worth on fresh episodes; [refinement] gate = false switches it off."""


@dataclass(frozen=True, slots=True)
class Gathered:
    """Pairs to learn from, and what a card says of them."""

    pairs: Pairs
    sequences: tuple[tuple[str, ...], ...]
    started: int  # pairs of episodes that were run


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("robot", help="whose models")
    parser.add_argument("--scenario", default="approach-dribble", help="to run (default: %(default)s)")
    parser.add_argument(
        "--episodes", type=at_least(1, "--episodes"), default=1200, help="pairs to run (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=at_least(0, "--seed"), default=DEFAULT_SEED, help="of the first start (default: %(default)s)"
    )
    parser.add_argument("--learner", default="forest", help="forest, tree (default: %(default)s)")
    parser.add_argument("--price", type=finite("--price"), default=0.1, metavar="POINTS", help=PRICE)
    parser.add_argument("--jobs", type=processes, default=2, help="processes (default: %(default)s)")
    parser.add_argument("--zoo", type=Path, default=ZOO, help="folder of models (default: the one that ships)")
    parser.add_argument(
        "--store", type=Path, default=Path("out/evaluate"), help="finished episodes (default: %(default)s)"
    )
    parser.add_argument("--json", action="store_true", help="print what the test said as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Gather, learn, publish, check; exit code 0."""
    from tailor.models.runtime import load_model

    path, test = train(arguments)
    load_model(path)  # a model that does not pass its own check must not ship
    if arguments.json:
        print(json.dumps(test))
        return 0
    plain = test["ungated"]
    console = Console(highlight=False)
    console.print(f"{path}: learned from {test['n']} pairs; on pairs that its twins had not seen:")
    console.print(f"  right {test['right_pct']:.1f} % (always refining: {plain['right_pct']:.1f} %)")
    without, best = plain["improvement_pct"], test["perfect"]["improvement_pct"]
    console.print(f"  improvement {without:.2f} % without, {test['improvement_pct']:.2f} % with the tree,", end=" ")
    console.print(f"{best:.2f} % were it always right")
    console.print(f"  slower episodes {plain['slower_pct']:.1f} % without, {test['slower_pct']:.1f} % with the tree")
    return 0


def train(arguments: argparse.Namespace) -> tuple[Path, dict[str, Any]]:
    """Make the tree and write it to the zoo; returns where it lies, and its test."""
    from tailor.executive.refinement.gate import SITUATION
    from tailor.models.export.gate_publishing import publish_gate
    from tailor.models.training.gate_training import check_learner, train_gate
    from tailor.tools.evaluations.outcome import Task
    from tailor.tools.learning import gathering

    check_learner(arguments.learner, arguments.episodes)  # told before an hour of runs, not after
    domain = gathering.domain_of(arguments.robot)
    settings = RefinementSettings(gate=False)
    zoo = "" if arguments.zoo == ZOO else str(arguments.zoo)
    found = gathered(Task(domain, arguments.scenario, zoo=zoo), settings, arguments)
    trained = train_gate(found.pairs, SITUATION, arguments.learner, arguments.seed, arguments.price)
    episodes = {
        "scenario": arguments.scenario,
        "started": found.started,
        "seed": arguments.seed,
        "source_sha256": gathering.source_hash(arguments.robot, domain),
    }
    about = _about(arguments, settings, found.sequences, episodes)
    return publish_gate(arguments.zoo, found.pairs, trained, about), dict(trained.test)


def _about(
    arguments: argparse.Namespace,
    settings: RefinementSettings,
    sequences: tuple[tuple[str, ...], ...],
    episodes: dict[str, Any],
) -> GateProvenance:
    """What the card is to say, the action models that the tree was learned with among it."""
    from tailor.executive.composition import load_models
    from tailor.executive.refinement.gate import SITUATION
    from tailor.models.export.gate_publishing import GateProvenance

    loaded: Any = load_models(arguments.robot, "" if arguments.zoo == ZOO else str(arguments.zoo))
    models = {**loaded.durations, **loaded.successes}
    return GateProvenance(
        arguments.robot,
        SITUATION,
        sequences,
        {name: model.card["sha256"] for name, model in sorted(models.items()) if not name.endswith("/energy")},
        dataclasses.asdict(settings),
        episodes,
        arguments.learner,
        arguments.seed,
        _command(arguments),
    )


def gathered(task: Task, settings: RefinementSettings, arguments: argparse.Namespace) -> Gathered:
    """Run every start greedy and refined.

    Raises:
      UsageError: Seeds that are kept for evaluations.
    """
    from tailor.tools.evaluations.outcome import FIRST_SEED, Variant
    from tailor.tools.evaluations.task_runs import run_all

    end = arguments.seed + arguments.episodes
    if not 0 <= arguments.seed < end <= FIRST_SEED:
        raise UsageError(f"seeds {arguments.seed} .. {end}, expected some from 0 to {FIRST_SEED}: fresh ones judge")
    variants = [Variant(f"h{h}", replace(settings, horizon=h)) for h in (1, 2)]
    seeds = range(arguments.seed, end)
    found = run_all(task, variants, seeds, arguments.jobs, arguments.store, "greedy and refined")
    both = [(found["h1"][seed], found["h2"][seed]) for seed in seeds]
    return Gathered(pairs_of(both), _sequences(refined for _, refined in both), len(both))


def pairs_of(outcomes: Sequence[tuple[Outcome, Outcome]]) -> Pairs:
    """The pairs (greedy, refined) that reached their goal both ways and in which there was something to choose."""
    import numpy as np

    from tailor.models.training.gate_training import Pairs

    usable = [(g, r) for g, r in outcomes if g.achieved and r.achieved and r.situation]
    return Pairs(
        np.array([refined.situation for _, refined in usable]),
        np.array([greedy.duration_s for greedy, _ in usable]),
        np.array([refined.duration_s for _, refined in usable]),
    )


def _sequences(outcomes: Any) -> tuple[tuple[str, ...], ...]:
    """The kinds of sequences that were compared: names of actions within the horizon, asserted subgoals left out."""
    kinds = {
        tuple(name for name, asserted, _ in outcome.predicted_actions if not asserted)[:2]
        for outcome in outcomes
        if outcome.situation
    }
    return tuple(sorted(kinds))


def _command(arguments: argparse.Namespace) -> str:
    return (
        f"tailor train-gate {arguments.robot} --scenario {arguments.scenario} --episodes {arguments.episodes} "
        f"--seed {arguments.seed} --learner {arguments.learner} --price {arguments.price:g}"
    )
