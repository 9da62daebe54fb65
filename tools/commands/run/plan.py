"""Find a partial-order plan with causal links for a PDDL problem, VHPOP-style.

Prints the plan in plain form, START:(action args)[duration]. Options have the letters and names of VHPOP. Exit codes:
0 plan found, 1 no plan (unsolvable, or a limit reached), 2 bad input.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import sys
import time
from functools import partial

from tailor.executive.planning import Domain, Problem, Result, Unsupported, parse_domain, parse_problem, validate
from tailor.runtime.planners.named import check_engine, kairos_command, kairos_installed
from tailor.schemas.errors import UsageError
from tailor.tools.plan_search.limits import MAX_PLANS, Limits
from tailor.tools.plan_search.sources import GRACE_S, anytime, anytime_beside_kairos, built_in, external, with_kairos
from tailor.tools.planning import options
from tailor.tools.planning.ignored_options import refuse_ignored
from tailor.tools.planning.options import settings_of
from tailor.tools.planning.output import as_json, print_result
from tailor.tools.planning.pddl_files import read_texts

configure = options.configure


def run(args: argparse.Namespace) -> int:
    """Plans and prints; returns exit code 0 with a plan, 1 without, 2 if the problem is not supported."""
    refuse_ignored(args)
    started = time.process_time()
    try:
        texts = read_texts(args.files)  # read once: standard input cannot be read again
        domain = parse_domain(texts[0], str(args.files[0]))
        problem = parse_problem(texts[1], domain, str(args.files[-1]))
    except Unsupported as feature:
        if args.json:
            print(json.dumps(as_json(Result("unsupported", None, str(feature), 0, 0), args.files[-1].stem, 0.0)))
        raise
    if args.compare:
        return _compare(args, texts, domain, problem)
    check_engine(args.planner or "")
    result = _validated(_plan(args, texts, domain, problem), domain, problem)
    cpu_ms = (time.process_time() - started) * 1e3
    if args.verbose:
        print(f"generated {result.generated}, visited {result.visited}, {cpu_ms:.1f} ms CPU", file=sys.stderr)
    print_result(args, result, problem, cpu_ms)
    if result.plan is not None:
        return 0
    return 2 if result.status == "unsupported" else 1


def _compare(args: argparse.Namespace, texts: tuple[str, str], domain: Domain, problem: Problem) -> int:
    """Prints the figures of our plan and of the other planners'; exit code 0 if ours is sound."""
    from tailor.tools.planning.comparison import compare

    for form in ("links", "dot", "svg"):
        if getattr(args, form):
            raise UsageError(f"--compare prints figures, as a table or --json, and no plan: leave out --{form}")
    if args.time_limit is None:
        args.time_limit = 1.0
    plan, limit_s = partial(_plan, args, texts, domain, problem), 60.0 * args.time_limit
    rows = compare(args.planner or "", plan, args.compare, texts, problem, limit_s)
    if args.json:
        print(json.dumps([dataclasses.asdict(row) for row in rows]))
    else:
        from tailor.tools.cli.terminal import table_console
        from tailor.tools.planning.comparison import table

        table_console().print(table(rows, problem.name))
    return 0 if rows[0].valid else 1


def _validated(result: Result, domain: Domain, problem: Problem) -> Result:
    """The result, without the plan if that is unsound."""
    fault = validate(result.plan, domain, problem) if result.plan is not None else ""
    if not fault:
        return result
    return dataclasses.replace(result, status="limit", plan=None, reason=f"the plan is unsound: {fault}")


def _plan(args: argparse.Namespace, texts: tuple[str, str], domain: Domain, problem: Problem) -> Result:
    """The result of the planner or engine that the options name."""
    limit_s = 60.0 * args.time_limit if args.time_limit is not None else math.inf
    if args.planner:
        return external(args.planner, texts, domain, problem, limit_s)
    if args.engine == "kairos":
        return external(kairos_command(limit_s, args.tolerance), texts, domain, problem, limit_s + GRACE_S)
    settings, limits = settings_of(args), Limits(limit_s, args.memory_limit)
    if args.engine == "auto" and args.node_limit == MAX_PLANS and not args.orders and _kairos_applies(domain):
        plan = anytime_beside_kairos if args.anytime else with_kairos
        result, planner = plan(texts, domain, problem, settings, limits)
        if planner and args.verbose:
            print(f"the plan is by {planner}", file=sys.stderr)
        return result
    if args.anytime:
        from tailor.executive.planning import AnytimeSearch

        return anytime(AnytimeSearch(domain, problem, settings), limits)
    return built_in(domain, problem, settings, limits)


def _kairos_applies(domain: Domain) -> bool:
    """Whether the domain has durations and kairos-planner is installed."""
    return domain.durative and kairos_installed()
