"""Reproduce the paper's tables and figures, with its figures beside ours."""

from __future__ import annotations

import argparse
import importlib
import itertools
import sys
from typing import Any

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.tools.evaluations.overview import page_is_there, write_overview

# name -> (module, one line of help); the modules offer configure(parser) and run(arguments) -> exit code
EVALUATIONS: dict[str, tuple[str, str]] = {
    "table1": (
        "tailor.tools.evaluations.models.table1",
        "duration models: episodes, mean duration, error on fresh episodes",
    ),
    "table2": ("tailor.tools.evaluations.models.table2", "failure model: confusion matrix over fresh approaches"),
    "feature-spaces": ("tailor.tools.evaluations.models.feature_spaces", "Figure 6 b: error in three feature spaces"),
    "duration-learners": (
        "tailor.tools.evaluations.models.duration_learners",
        "ours, boosting and WEKA's M5P on the same folds",
    ),
    "failure-learners": (
        "tailor.tools.evaluations.models.failure_learners",
        "trees, forest, network, SVM, boosting, J48",
    ),
    "on-policy": ("tailor.tools.evaluations.models.on_policy", "what a round of the optimiser's own choices changes"),
    "table3": ("tailor.tools.evaluations.refinement.table3", "refined against greedy subgoals, paired"),
    "letters": ("tailor.tools.evaluations.arm.letters", "Table 3's arm: letters by stopping, greedy and refined hands"),
    "table4": ("tailor.tools.evaluations.refinement.table4", "refinement by horizon over four waypoints"),
    "gate": ("tailor.tools.evaluations.refinement.gate", "when not to refine: a tree that predicts slower episodes"),
    "energy": (
        "tailor.tools.evaluations.refinement.energy",
        "time against energy: what a joule's worth in seconds changes",
    ),
    "figure1": (
        "tailor.tools.evaluations.refinement.figure1",
        "paths, greedy and refined, and how smooth actions pass over",
    ),
    "figure11": (
        "tailor.tools.evaluations.refinement.figure11",
        "durations over the angle of approach, predicted and simulated",
    ),
    "figure15": (
        "tailor.tools.evaluations.assertion.figure15",
        "where an asserted subgoal may lie, and the runs without and with it",
    ),
    "figure16": ("tailor.tools.evaluations.assertion.figure16", "approaches with and without subgoal assertion"),
    "live": ("tailor.tools.evaluations.live.live", "a sample live over the bus against the same starts in lock-step"),
}
ALL = "all"
RESUME = "--resume"
STOPPED = 130
EPILOG = """
`tailor evaluate NAME --help` tells its own flags. With `all`, each evaluation takes the flags that it knows.
--resume: leave out what has a page in the report's folder already. Finished episodes are kept in any case.

examples:
  tailor evaluate table3 table4 figure16 --domain soccer --report out/report
  tailor evaluate all --report out/report --resume
"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments; each evaluation declares its own flags."""
    width = max(map(len, EVALUATIONS))
    rows = [f"  {name:<{width}}  {text}" for name, (_, text) in EVALUATIONS.items()]
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.usage = "tailor evaluate NAME [NAME ...] [--json] [--report DIR [--resume]] [...]"
    parser.epilog = "\n".join(["evaluations:", *rows, f"  {ALL:<{width}}  the lot", EPILOG])
    parser.add_argument("words", nargs=argparse.REMAINDER, metavar="NAME", help="which evaluations, then their flags")


def run(arguments: argparse.Namespace) -> int:
    """Run each evaluation; the exit code is the worst of theirs."""
    names, flags = _names_and_flags(arguments.words)
    everything = ALL in arguments.words[:1]
    chosen = _chosen(names, [flag for flag in flags if flag != RESUME], everything)  # a wrong flag is told first
    code = 0
    for name, module, settings in chosen:
        if RESUME in flags and settings.report is not None and page_is_there(settings.report, name):
            continue
        done = _run_one(name, module, settings, everything)
        if settings.report is not None:
            write_overview(settings.report, list(EVALUATIONS))
        if done == STOPPED:
            return STOPPED
        code = max(code, done)
    return code


def _run_one(name: str, module: Any, settings: argparse.Namespace, everything: bool) -> int:
    """One evaluation; where the lot is asked for, one that cannot run does not keep the others from it."""
    try:
        return int(module.run(settings))
    except UsageError as error:
        if not everything:
            raise
        print(f"tailor evaluate {name}: {error}", file=sys.stderr)
        return 2


def _names_and_flags(words: list[str]) -> tuple[list[str], list[str]]:
    leading = list(itertools.takewhile(lambda word: word == ALL or word in EVALUATIONS, words))
    names = list(EVALUATIONS) if ALL in leading else leading
    if not names:
        asked = f"evaluation '{words[0]}' is unknown" if words else "no evaluation named"
        raise UsageError(f"{asked} (expected some of: {', '.join(EVALUATIONS)}, {ALL})")
    return names, words[len(leading) :]


def _chosen(names: list[str], flags: list[str], everything: bool) -> list[tuple[str, Any, argparse.Namespace]]:
    """Evaluations with their modules and settings; of the lot, those of another domain are left out."""
    parsed = [(name, *_parsed(name, flags)) for name in names]
    unknown = [rest for *_, rest in parsed]
    needed = all if everything else any
    nobodys = [group[0] for group in _groups(flags) if needed(group[0] in rest for rest in unknown)]
    if nobodys:
        raise UsageError(f"unknown: {' '.join(nobodys)} (`tailor evaluate NAME --help` tells an evaluation's flags)")
    chosen = []
    for name, module, settings, _ in parsed:
        known = getattr(module, "DOMAINS", ("soccer",))
        if not settings.domain or settings.domain in known:
            chosen.append((name, module, settings))
        elif not everything:
            raise UsageError(f"--domain {settings.domain}: {name} is of: {', '.join(known)}")
    return chosen


def _groups(flags: list[str]) -> list[list[str]]:
    """Each flag with its values; words before the first flag are one group, too."""
    starts = [i for i, word in enumerate(flags) if i == 0 or word.startswith("--")]
    return [flags[a:b] for a, b in itertools.pairwise([*starts, len(flags)])]


def _parsed(name: str, flags: list[str]) -> tuple[Any, argparse.Namespace, list[str]]:
    module = importlib.import_module(EVALUATIONS[name][0])
    parser = argparse.ArgumentParser(prog=f"tailor evaluate {name}", description=module.__doc__, allow_abbrev=False)
    module.configure(parser)
    groups = _groups(flags)
    unknown = [group[0] for group in groups if group[0] in parser.parse_known_args(group)[1]]
    settings = parser.parse_args([word for group in groups if group[0] not in unknown for word in group])
    if settings.domain and hasattr(settings, "robot"):
        settings.robot = domains.load(settings.domain).robot
    return module, settings, unknown
