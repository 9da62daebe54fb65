"""The project's own planning problems, the counts of VHPOP for them, and shortcuts to plan in tests."""

import csv
from pathlib import Path

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import MATCHING, Search, parse_domain, parse_problem
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import ground_actions, static_world
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.ground_plans.partial_plan import initial_plan
from tailor.executive.planning.plans.portions import completed_work
from tailor.tools.benchmarks.planning_scale import problem_text

DATA = Path(__file__).parents[2] / "data" / "pddl"
SHARED = Path(__file__).parents[4] / "shared" / "pddl"
OWN = tuple(sorted(p.stem for p in (DATA / "own").glob("*.pddl") if not p.stem.endswith("-domain")))
UNLIMITED = 10**9  # checks


def load(domain_file, problem_file):
    domain = parse_domain(domain_file.read_text(), domain_file.name)
    return domain, parse_problem(problem_file.read_text(), domain, problem_file.name)


def own(name):
    """Domain and problem of one of the project's own problems."""
    return load(DATA / "own" / f"{name.rsplit('-', 1)[0]}-domain.pddl", DATA / "own" / f"{name}.pddl")


def read(domain_text, problem_text):
    domain = parse_domain(domain_text)
    return domain, parse_problem(problem_text, domain)


def solve(domain, problem, settings=MATCHING):
    return Search(domain, problem, settings).advance(CheckBudget(UNLIMITED))


def refined(domain_text, problem_text, times):
    """The ground task, and the plan in which the newest condition got its first resolver so many times."""
    _, problem = read(domain_text, problem_text)
    *_, grounded = ground_actions(problem, static_world(problem), 0.01, 1000)
    task = completed_work(make_task(problem, grounded))
    plan = initial_plan(task)
    for _ in range(times):
        plan = refine_open(task, plan, plan.open)[0]
    return task, plan


def printed(name):
    """The output of VHPOP, without its line of time."""
    text = (DATA / "vhpop-output" / f"{name}.txt").read_text()
    return text[: text.rindex("Time:")]


def reference(folder, config, status="solved"):
    """The problems that VHPOP solved (status "": all that it tried): (domain, problem) -> row of the table.

    Empty when the folder is absent.
    """
    if not folder.exists():
        return {}
    with (folder / "reference.csv").open() as lines:
        rows = [row for row in csv.DictReader(lines) if row["config"] == config and status in ("", row["status"])]
    return {(row["domain"], row["problem"]): row for row in rows}


def many_cups(cups):
    """Kitchen domain, and a problem with n cups to carry from one table to another: 4 n steps."""
    return read((DATA / "own" / "kitchen-domain.pddl").read_text(), problem_text(cups))
