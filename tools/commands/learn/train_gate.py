"""Train the refinement gate (paper 6.3.2), which predicts whether refinement slows an episode down."""

from __future__ import annotations

import argparse
import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.installed import models_folder
from tailor.schemas.installed.source import episodes_sha256
from tailor.tools.cli.number_checks import at_least, finite, processes
from tailor.tools.learning.target_zoo import target_zoo

if TYPE_CHECKING:
    from tailor.models.export.gate_publishing import GateProvenance
    from tailor.tools.evaluations.gate_pairs import GatheredPairs

DEFAULT_SEED = 700_000
EPILOG = """\
examples:
  tailor train-gate agilo
  tailor train-gate agilo --episodes 300 --zoo out/zoo

The gate is valid only for the action models in the zoo, so train it after them; `tailor train` removes a gate that was
trained with other models. Run an interrupted command again to resume it. `tailor evaluate gate` measures the gate on
fresh episodes; [refinement] gate = false switches it off."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    add = parser.add_argument
    add("robot", help="name of the robot")
    add("--scenario", default="", help="scenario to run (default: the first of the robot's domain)")
    add("--episodes", type=at_least(1, "--episodes"), default=1200, help="pairs of episodes (default: %(default)s)")
    add("--seed", type=at_least(0, "--seed"), default=DEFAULT_SEED,
        help="random seed of the first start (default: %(default)s)")  # fmt: skip
    add("--learner", default="forest", help="learner: forest, tree (default: %(default)s)")
    add("--price", type=finite("--price"), default=0.1, metavar="POINTS",
        help="improvement to give up for fewer slowdowns, in percentage points (default: %(default)s)")  # fmt: skip
    add("--jobs", type=processes, default=2, help="number of processes (default: %(default)s)")
    add("--zoo", type=Path, metavar="DIR",
        help="folder of the action models and of the gate (default: that of the robot's package)")  # fmt: skip
    add("--store", type=Path, default=Path("out/evaluate"), help="folder of finished episodes (default: %(default)s)")
    add("--json", action="store_true", help="print the test results as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Gather, train, publish, check; exit code 0."""
    from tailor.models.runtime import load_model

    path, test = train(arguments, target_zoo(arguments.zoo, arguments.robot))
    load_model(path)  # a model that fails its own checks must not ship
    if arguments.json:
        print(json.dumps(test))
        return 0
    plain = test["ungated"]
    console = Console(highlight=False)
    console.print(f"{path}: trained on {test['n']} pairs; test results on held-out pairs:")
    console.print(f"  correct {test['right_pct']:.1f} % (without gate: {plain['right_pct']:.1f} %)")
    without, best = plain["improvement_pct"], test["perfect"]["improvement_pct"]
    console.print(f"  improvement {without:.2f} % without, {test['improvement_pct']:.2f} % with the gate,", end=" ")
    console.print(f"{best:.2f} % with a perfect one")
    console.print(f"  slower episodes {plain['slower_pct']:.1f} % without, {test['slower_pct']:.1f} % with the gate")
    return 0


def train(arguments: argparse.Namespace, zoo: Path) -> tuple[Path, dict[str, Any]]:
    """Train the gate and write it to the zoo.

    Returns:
      The path of its ONNX file, and its test results.
    """
    from tailor.executive import domains
    from tailor.executive.refinement.gate import SITUATION
    from tailor.models.export.gate_publishing import publish_gate
    from tailor.models.training.gate_training import check_learner, train_gate
    from tailor.tools.evaluations.gate_pairs import gather_pairs, training_seeds
    from tailor.tools.evaluations.outcome import Task
    from tailor.tools.learning import gathering

    check_learner(arguments.learner, arguments.episodes)  # fails before an hour of runs, not after
    domain = gathering.domain_of(arguments.robot)
    arguments.scenario = arguments.scenario or domains.scenarios(domain)[0]
    settings = RefinementSettings(gate=False)
    seeds = training_seeds(arguments.seed, arguments.episodes)
    task = Task(domain, arguments.scenario, zoo=_zoo_setting(arguments.robot, zoo))
    gathered = gather_pairs(task, settings, seeds, arguments.jobs, arguments.store)
    trained = train_gate(gathered.pairs, SITUATION, arguments.learner, arguments.seed, arguments.price)
    provenance = _provenance(arguments, zoo, settings, gathered, episodes_sha256(domain))
    return publish_gate(zoo, gathered.pairs, trained, provenance), dict(trained.test)


def _zoo_setting(robot: str, zoo: Path) -> str:
    """The zoo as settings name it: empty for the package's own."""
    return "" if zoo == models_folder(robot) else str(zoo)


def _provenance(
    arguments: argparse.Namespace,
    zoo: Path,
    settings: RefinementSettings,
    gathered: GatheredPairs,
    source_sha256: str,
) -> GateProvenance:
    """Provenance for the gate's card, including the action models that it was trained with."""
    from tailor.executive.composition import load_models
    from tailor.executive.refinement.gate import SITUATION
    from tailor.models.export.gate_publishing import GateProvenance

    loaded: Any = load_models(arguments.robot, _zoo_setting(arguments.robot, zoo))
    models = {**loaded.durations, **loaded.successes}
    episodes = {
        "scenario": arguments.scenario,
        "started": gathered.started,
        "seed": arguments.seed,
        "source_sha256": source_sha256,
    }
    return GateProvenance(
        arguments.robot,
        SITUATION,
        gathered.sequences,
        {name: model.card["sha256"] for name, model in sorted(models.items()) if not name.endswith("/energy")},
        dataclasses.asdict(settings),
        episodes,
        arguments.learner,
        arguments.seed,
        _command(arguments),
    )


def _command(arguments: argparse.Namespace) -> str:
    """The command that reproduces the gate."""
    return (
        f"tailor train-gate {arguments.robot} --scenario {arguments.scenario} --episodes {arguments.episodes} "
        f"--seed {arguments.seed} --learner {arguments.learner} --price {arguments.price:g}"
    )
