"""The evaluations that there are, and which of them words on a command line choose, each with its flags."""

from __future__ import annotations

import argparse
import importlib
import itertools
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.schemas.errors import UsageError

# name -> (module of this room, one line of help); the modules offer configure(parser) and run(arguments) -> exit code
_MODULES = {
    "models": (
        "models.models",
        "any domain: errors of the action models on fresh episodes, coverage of their intervals",
    ),
    "table1": ("models.table1", "duration models: episodes, mean duration, error on new episodes"),
    "table2": ("models.table2", "failure model: confusion matrix over new approaches"),
    "feature-spaces": ("models.feature_spaces", "Figure 6 b: error in its three feature spaces and one of ours"),
    "duration-learners": ("models.duration_learners", "our learners, boosting and WEKA's M5P on the same folds"),
    "failure-learners": ("models.failure_learners", "trees, forest, network, SVM, boosting and J48 on the same folds"),
    "on-policy": ("models.on_policy", "change by one round of training on the optimiser's own choices"),
    "learning-curves": (
        "models.learning_curves",
        "any domain: gain by refinement over the number of episodes, random, on-policy and active",
    ),
    "refinement": ("refinement.refinement", "any domain: refined against greedy, with every cost in its column"),
    "table3": ("refinement.table3", "refined against greedy subgoals, paired by start"),
    "letters": ("arm.letters", "letters by the arm (Table 3): stopping, greedy and refined"),
    "table4": ("refinement.table4", "refinement with horizons 1 to 4 over four waypoints"),
    "ablations": ("refinement.ablations", "refinement with one part off at a time, paired with the default"),
    "energy": ("refinement.energy", "duration against energy for different weights of energy"),
    "figure1": ("refinement.figure1", "paths, greedy and refined, and the smoothness of transitions between actions"),
    "figure11": ("refinement.figure11", "duration over the angle of approach, predicted and simulated"),
    "assertion": (
        "assertion.assertion",
        "success among objects: without and with asserted subgoals, and by hand-made geometry",
    ),
    "figure15": ("assertion.figure15", "cost of an asserted subgoal by place, and the runs without and with it"),
    "figure16": ("assertion.figure16", "approaches with and without subgoal assertion"),
    "live": ("live.live", "live runs over the bus against lock-step runs from the same starts"),
}
EVALUATIONS = {name: (f"tailor.tools.evaluations.{module}", text) for name, (module, text) in _MODULES.items()}
FOR_ANY_DOMAIN = ("refinement", "models", "learning-curves", "ablations")  # those that the paper's tables are names for
ALL = "all"
Chosen = tuple[str, Any, argparse.Namespace]  # an evaluation: name, module, settings


def names_and_flags(words: list[str]) -> tuple[list[str], list[str]]:
    """Leading names of evaluations, and all words after them."""
    leading = list(itertools.takewhile(lambda word: word == ALL or word in EVALUATIONS, words))
    names = [name for name in EVALUATIONS if name not in FOR_ANY_DOMAIN] if ALL in leading else leading
    if not names:
        problem = f"evaluation '{words[0]}' is unknown" if words else "no evaluation named"
        raise UsageError(f"{problem}, expected some of: {', '.join(EVALUATIONS)}, {ALL}")
    return names, words[len(leading) :]


def domains_of(module: Any) -> tuple[str, ...]:
    """Domains that an evaluation is for unless --domain names another one."""
    return tuple(getattr(module, "DOMAINS", ("soccer",)))


def chosen_of(names: list[str], flags: list[str], everything: bool) -> list[Chosen]:
    """Evaluations with their modules and settings; with `all`, those of another domain are omitted."""
    parsed = [(name, *_parsed(name, flags)) for name in names]
    unknown = [rest for *_, rest in parsed]
    needed = all if everything else any
    unused = [group[0] for group in _groups(flags) if needed(group[0] in rest for rest in unknown)]
    if unused:
        raise UsageError(
            f"unknown: {' '.join(unused)} (`tailor evaluate NAME --help` lists the flags of an evaluation)"
        )
    chosen = []
    for name, module, settings, _ in parsed:
        has = domains_of(module)
        if not settings.domain or name in FOR_ANY_DOMAIN or settings.domain in has:
            if not everything and hasattr(module, "check"):  # with `all`, a flag may be for another one
                module.check(settings)
            chosen.append((name, module, settings))
        elif not everything:
            raise UsageError(f"--domain {settings.domain}: {name} has: {', '.join(has)}")
    if not chosen:  # that nothing ran would pass for a success
        of_any = ", ".join(FOR_ANY_DOMAIN)
        raise UsageError(f"--domain {parsed[0][2].domain}: none of the paper's evaluations has it, expected {of_any}")
    return chosen


def _groups(flags: list[str]) -> list[list[str]]:
    """Each flag with its values; words before the first flag form a group of their own."""
    starts = [i for i, word in enumerate(flags) if i == 0 or word.startswith("--")]
    return [flags[a:b] for a, b in itertools.pairwise([*starts, len(flags)])]


def _parsed(name: str, flags: list[str]) -> tuple[Any, argparse.Namespace, list[str]]:
    """Module and settings of one evaluation, and the flags that it does not have."""
    module = importlib.import_module(EVALUATIONS[name][0])
    parser = argparse.ArgumentParser(prog=f"tailor evaluate {name}", description=module.__doc__, allow_abbrev=False)
    module.configure(parser)
    groups = _groups(flags)
    unknown = [group[0] for group in groups if group[0] in parser.parse_known_args(group)[1]]
    settings = parser.parse_args([word for group in groups if group[0] not in unknown for word in group])
    if settings.on and settings.zoo:
        settings.zoo = str(Path(settings.zoo).resolve())  # workers have another working directory
    if settings.domain and hasattr(settings, "robot"):
        settings.robot = domains.load(settings.domain).robot
    return module, settings, unknown
