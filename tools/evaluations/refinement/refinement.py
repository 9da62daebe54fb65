"""Refined against greedy for any domain: pairs of runs from the same starts, with every cost in its column.

The paper's Tables 3 and 4 and its letters are this evaluation over the paper's scenarios.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import add_count, at_least
from tailor.tools.evaluations.pages.plots import draw_pairs
from tailor.tools.evaluations.pages.report import Report, configure_report, publish_report
from tailor.tools.evaluations.paired_comparison import MIN_UNITS
from tailor.tools.evaluations.refinement.failed_runs import failure_remarks
from tailor.tools.evaluations.refinement.paired_outcomes import is_better
from tailor.tools.evaluations.refinement.refinement_rows import rows_of
from tailor.tools.evaluations.refinement.replicas import Recipe, configure_replicas, over_models, replica
from tailor.tools.evaluations.refinement.settings_flag import configure_settings, settings_from, settings_remark
from tailor.tools.evaluations.seeds import seeds_of
from tailor.tools.evaluations.tick_budget import budget_remark, configure_tick_budget
from tailor.tools.lockstep.bodies import body_of

POINTS, ORACLE_RUNS = 18, 40
REMARKS = (
    "pairs: greedy and refined from one start with the same noise; n: both achieved the goal; failed: pairs left out; "
    "failures and contacts: share of all runs; arrival: mean error at the ends of the actions, by the ground truth",
    "95 % interval: of the improvement, over independent units; total: gain in percent of the sum of all greedy "
    "seconds; difference: refined minus greedy; p: paired t-test, for shares McNemar's exact test; bias: predicted "
    "minus actual duration of an action",
)
FEW_REMARK = (
    f"all: the mean over scenarios, without an interval: fewer than {MIN_UNITS} units tell nothing about others; the "
    "row of each scenario has its own, over starts"
)
ORACLE_REMARK = (
    "oracle: the best of all simulated choices, the ceiling; oracle again: its choices with other noise; "
    "share of oracle: of the ceiling's gain; oracle greedy: the choice whose first action ends soonest; zero: all free "
    "parameters zero; oracle half: of an oracle that searches, after half of its runs"
)


@dataclass(frozen=True, slots=True)
class Preset:
    """A name for this evaluation with a paper's scenarios.

    Attributes:
      name: Of the evaluation.
      title: Of its report.
      scenarios: Names by domain; those of other domains cannot be evaluated. None: all scenarios of any domain.
      paper: What the paper reports, by domain.
    """

    name: str = "refinement"
    title: str = "Refined against greedy"
    scenarios: Mapping[str, Sequence[str]] | None = None
    paper: Mapping[str, str] | None = None


def configure(
    parser: argparse.ArgumentParser, episodes: int = 200, horizons: Sequence[int] = (2,), oracle: int = 0
) -> None:
    """Flags of `tailor evaluate refinement`, and of its names for the paper's tables."""
    parser.add_argument("--scenario", nargs="+", metavar="S",
                        help="scenarios of the domain (default: all; of table3 and table4 the paper's)")  # fmt: skip
    parser.add_argument("--horizon", nargs="+", type=at_least(2, "--horizon"), default=list(horizons), metavar="H",
                        help="horizons of refinement, at least 2 (default %(default)s)")  # fmt: skip
    add_count(parser, "--episodes", 2, episodes, "pairs of each scenario")
    parser.add_argument("--profile", default="", help="profile of the body, e.g. degraded (default: as trained on)")
    add_count(parser, "--oracle", 0, oracle, "starts at which choices are simulated", metavar="N")
    parser.add_argument("--points", type=at_least(2, "--points"),
                        help=f"angles that the oracle tries (default {POINTS})")  # fmt: skip
    parser.add_argument("--oracle-runs", type=at_least(2, "--oracle-runs"), metavar="N",
                        help=f"runs a start where choices are too many for all (default {ORACLE_RUNS})")  # fmt: skip
    configure_settings(parser)
    configure_tick_budget(parser)
    configure_replicas(parser)
    configure_report(parser)


def run(arguments: argparse.Namespace, preset: Preset | None = None) -> int:
    """Evaluate and publish the report; 0 if every row `is_better`."""
    named = preset or Preset()
    of_oracle = {"points": arguments.points or POINTS, "oracle_runs": arguments.oracle_runs or ORACLE_RUNS}
    horizons = list(dict.fromkeys(arguments.horizon))  # one that is named twice would be run twice
    arguments = argparse.Namespace(**{**vars(arguments), **of_oracle, "horizon": horizons})
    domain, scenarios = _scenarios(arguments, named)
    _refuse_ignored(arguments)
    settings_from(arguments.refinement)  # raises before anything runs
    body_of(domain, arguments.profile)  # raises on an unknown profile before anything runs
    rows, plots = [], {}
    failed: list[str] = []
    seeds = seeds_of(domain, arguments)
    for number, zoo in enumerate([arguments.zoo, *_other_models(domain, scenarios, arguments)]):
        settings = argparse.Namespace(**{**vars(arguments), "zoo": zoo, "oracle": 0 if number else arguments.oracle})
        own = seeds_of(domain, settings)
        name = f"trained anew, {number}" if number else "as shipped"
        model = {"model": name, "first_seed": own.first} if arguments.models else {}
        made, pairs = rows_of(domain, scenarios, own, settings)
        rows += [{**model, **row} for row in made]
        failed = failed or list(failure_remarks(pairs))
        if arguments.report is not None and not number:
            path = arguments.report / f"{named.name}.png"
            both = [pair for pair in pairs.values() if pair[0].is_timed and pair[1].is_timed]
            greedy_s, refined_s = ([pair[side].duration_s for pair in both] for side in (0, 1))
            plots["greedy and refined"] = draw_pairs(greedy_s, refined_s, path)
    few = [] if all("ci95" in row for row in rows) else [FEW_REMARK]
    remarks = [*_paper(named, domain), *REMARKS, *few, *failed, *budget_remark(arguments.tick_ms)]
    remarks += settings_remark(arguments.refinement)
    remarks += [ORACLE_REMARK] if arguments.oracle else []
    over = over_models([row for row in rows if row.get("model", "").startswith("trained")])
    report = Report(named.name, f"{named.title}: {domain}", [*rows, *over], remarks, plots, seeds.provenance)
    publish_report(report, arguments)
    return 0 if all(is_better(row) for row in rows) else 1


def check(arguments: argparse.Namespace) -> None:
    """Raise UsageError for flags of an oracle that is not asked for."""
    given = {"--points": arguments.points, "--oracle-runs": arguments.oracle_runs}
    ignored = [flag for flag, number in given.items() if number is not None]
    if ignored and not arguments.oracle:
        raise UsageError(f"{', '.join(ignored)}: of the oracle, expected none without --oracle N")


def _refuse_ignored(arguments: argparse.Namespace) -> None:
    """Raise UsageError for numbers of models that are not made: the figures would pass for theirs."""
    numbers = {"--model-episodes": arguments.model_episodes, "--model-runs": arguments.model_runs}
    given = [flag for flag, number in numbers.items() if number is not None]
    if given and not arguments.models:
        raise UsageError(f"{', '.join(given)}: of the models that --models K makes, expected none without it")


def _scenarios(arguments: argparse.Namespace, preset: Preset) -> tuple[str, list[str]]:
    """Domain and scenarios to evaluate.

    Raises:
      UsageError: No or an unknown domain, or an unknown scenario.
    """
    named = preset.scenarios
    domain = arguments.domain or (next(iter(named)) if named else "")
    if not domain:
        raise UsageError("no domain named, expected --domain NAME")
    known = domains.scenarios(domain)
    wanted = arguments.scenario or (list(named[domain]) if named else known)
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise UsageError(f"unknown scenario '{unknown[0]}' of {domain}, expected some of: {', '.join(known)}")
    return domain, list(dict.fromkeys(wanted))


def _other_models(domain: str, scenarios: Sequence[str], arguments: argparse.Namespace) -> list[str]:
    """Zoos of models that are trained anew."""
    recipe = Recipe(domain, tuple(scenarios), arguments.model_episodes, arguments.model_runs)
    numbers = range(1, arguments.models + 1)
    return [str(replica(recipe, number, arguments.store, arguments.jobs).zoo) for number in numbers]


def _paper(preset: Preset, domain: str) -> list[str]:
    reported = (preset.paper or {}).get(domain)
    return [f"paper: {reported}"] if reported else []
