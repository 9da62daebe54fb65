"""Rows of the comparison of refined and greedy runs: one for each scenario and horizon, one over all scenarios."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from tailor.tools.evaluations.oracles.baselines import against_oracle
from tailor.tools.evaluations.oracles.grid import grid_size, simulate_choices, subgoal_parameters
from tailor.tools.evaluations.oracles.search import search_choices
from tailor.tools.evaluations.outcome import Outcome, Task, Variant
from tailor.tools.evaluations.refinement.paired_outcomes import Pair, Start, columns
from tailor.tools.evaluations.refinement.settings_flag import settings_from
from tailor.tools.evaluations.seeds import Seeds
from tailor.tools.evaluations.task_runs import run_all

GREEDY = 1  # horizon of greedy choices (paper 6.3)
MAX_GRID = 1000  # choices of a grid; beyond it the oracle searches
Found = Mapping[str, Mapping[int, Outcome]]  # by name of the variant, by seed


def rows_of(
    domain: str, scenarios: Sequence[str], seeds: Seeds, arguments: argparse.Namespace
) -> tuple[list[dict[str, Any]], dict[Start, Pair]]:
    """Rows for each scenario and horizon, one over all scenarios; and the pairs of the shortest horizon."""
    # Starts of its own for each scenario: those of one seed share noise, and temperatures or poses.
    own = {scenario: replace(seeds, first=seeds.first + k * arguments.episodes) for k, scenario in enumerate(scenarios)}
    found = {scenario: _run(_task(domain, scenario, arguments), own[scenario], arguments)
             for scenario in scenarios}  # fmt: skip
    rows: list[dict[str, Any]] = []
    first: dict[Start, Pair] = {}
    for horizon in arguments.horizon:
        pairs = {scenario: _pairs(scenario, some, GREEDY, horizon) for scenario, some in found.items()}
        shorter = max([h for h in arguments.horizon if h < horizon], default=GREEDY)
        for scenario in scenarios:
            row = {"scenario": scenario, "horizon": horizon, **columns(pairs[scenario])}
            rows.append(row | _over_shorter(scenario, found[scenario], shorter, horizon))
            if arguments.oracle and horizon == arguments.horizon[0]:
                rows[-1] |= _oracle(scenario, domain, own[scenario], found[scenario], arguments)
        together = {start: pair for some in pairs.values() for start, pair in some.items()}
        if len(scenarios) > 1:
            rows.append({"scenario": "all", "horizon": horizon, **columns(together, "scenario")})
        first = first or together
    return rows, first


def _run(task: Task, seeds: Seeds, arguments: argparse.Namespace) -> Found:
    base = settings_from(arguments.refinement)
    variants = [Variant(f"h{h}", replace(base, horizon=h)) for h in (GREEDY, *arguments.horizon)]
    return run_all(task, variants, seeds.starts(arguments.episodes), arguments.jobs, arguments.store, task.scenario)


def _task(domain: str, scenario: str, arguments: argparse.Namespace) -> Task:
    return Task(domain, scenario, arguments.profile, arguments.zoo, tick_ms=arguments.tick_ms)


def _pairs(scenario: str, found: Found, baseline: int, horizon: int) -> dict[Start, Pair]:
    one, other = found[f"h{baseline}"], found[f"h{horizon}"]
    return {(scenario, seed): (one[seed], other[seed]) for seed in sorted(one)}


def _over_shorter(scenario: str, found: Found, shorter: int, horizon: int) -> dict[str, Any]:
    """Improvement over the next shorter horizon; empty for the shortest one, where that is greedy."""
    if shorter == GREEDY:
        return {}
    row = columns(_pairs(scenario, found, shorter, horizon))
    return {"over_shorter_pct": row["improvement_pct"], "over_shorter_ci95": row["ci95"]}


def _oracle(scenario: str, domain: str, seeds: Seeds, found: Found, arguments: argparse.Namespace) -> dict[str, Any]:
    greedy, refined = found[f"h{GREEDY}"], found[f"h{arguments.horizon[0]}"]
    task = _task(domain, scenario, arguments)
    example = next((outcome for outcome in greedy.values() if outcome.achieved), None)
    free = [] if example is None else subgoal_parameters(example)
    if not free:
        return {}
    starts = seeds.starts(min(arguments.oracle, arguments.episodes))
    settings = replace(settings_from(arguments.refinement), horizon=arguments.horizon[0])
    jobs, store = arguments.jobs, arguments.store
    if grid_size(task, free, arguments.points) > MAX_GRID:
        half, judged = search_choices(task, starts, settings, arguments.oracle_runs, jobs, store)
        before = against_oracle(half, greedy, refined)
        return against_oracle(judged, greedy, refined) | {"oracle_half_pct": before["oracle_pct"]}
    return against_oracle(
        simulate_choices(task, free, starts, settings, arguments.points, jobs, store), greedy, refined
    )
