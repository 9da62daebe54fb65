"""Finds a partial-order plan for a PDDL problem and prints it with its causal links."""

from pathlib import Path

from tailor.planning import CheckBudget, Search, format_links, format_plan, parse_domain, parse_problem

PDDL = Path(__file__).parents[1] / "tests" / "data" / "pddl" / "own"

domain = parse_domain((PDDL / "kitchen-domain.pddl").read_text())
problem = parse_problem((PDDL / "kitchen-s1.pddl").read_text(), domain)
result = Search(domain, problem).advance(CheckBudget(10_000))
if result is None or result.plan is None:
    raise SystemExit("no plan")
print(format_plan(result.plan), format_links(result.plan), sep="\n")
