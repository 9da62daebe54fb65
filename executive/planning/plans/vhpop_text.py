"""Writes a plan as VHPOP prints it: the plain form, the causal-link form of the paper's Figure 10, or its beginning."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from tailor.executive.planning.pddl.formula_text import format_atom, format_number
from tailor.executive.planning.plans.plan import DEFAULT_TICK_S, GOAL, Link, Plan

EXCERPT_STEPS = 50
MAX_BOUNDS = 81  # rows of the table of a durative plan, which grows with the square of its steps: 40 of them
MAX_FACTS = 400  # of the initial state
_COUNT = re.compile(r"^; first [0-9]+ of ([0-9]{1,12}) steps$", flags=re.MULTILINE)


def format_plan(plan: Plan) -> str:
    """The plain form: `;problem`, then one line `START:(action args)` per step, with `[duration]` in durative plans.

    Args:
      plan: A finished plan.

    Returns:
      Text that `parse_plan` reads if there is a step; starts are levels from 1, or seconds in durative plans.
    """
    lines = [f";{plan.problem}"]
    for step in plan.steps:
        duration = f"[{format_number(step.duration)}]" if plan.durative else ""
        lines.append(f"{format_number(step.start)}:{format_atom(step.action)}{duration}")
    return "\n".join(lines) + "\n"


def format_links(plan: Plan) -> str:
    """The causal-link form; a durative plan's orderings are the bounds of its temporal network.

    Args:
      plan: A finished plan.

    Returns:
      Text that `parse_plan` reads. Bounds are in ticks of 0.01 s as in VHPOP; for another tolerance an additional
      line "tolerance = ..." (not part of VHPOP's format) gives the tick in seconds.
    """
    lines = [f";{plan.problem}", "Initial  :" + "".join(" " + format_atom(fact) for fact in plan.initial)]
    links: dict[int, list[Link]] = {}
    for link in plan.links:
        links.setdefault(link.consumer, []).append(link)
    for step in plan.steps:
        lines += ["", f"Step {step.id:<3} : {format_atom(step.action)}", *_links(links.get(step.id, []))]
    lines += ["", "Goal     : ", *_links(links.get(GOAL, []))]
    if plan.bounds:
        lines += ["orderings = ", *_matrix(plan)]
        if plan.tick_s != DEFAULT_TICK_S:
            lines.append(f"tolerance = {plan.tick_s!r}")
    else:
        lines.append("orderings = {" + "".join(f" {i}<{j}" for i, j in plan.orderings) + " }")
    if plan.bindings:
        lines += ["bindings = ", *plan.bindings]
    return "\n".join(lines) + "\n"


def format_excerpt(plan: Plan, steps: int = EXCERPT_STEPS) -> str:
    """The causal-link form of a plan, of a longer one only the first steps by start time: at most some 40 kB.

    Args:
      plan: A finished plan; an executed step is not in it, so the first step is the next one.
      steps: Maximum number of steps.

    Returns:
      Text that `parse_plan` reads. That of a longer plan has a second line "; first N of M steps", and only those links
      and orderings whose ends are in it. Of many initial facts it has those that the links name; in place of a large
      table of bounds it has orderings.
    """
    first = plan.steps[:steps]
    if len(first) == len(plan.steps) and len(plan.bounds) <= MAX_BOUNDS and len(plan.initial) <= MAX_FACTS:
        return format_links(plan)
    ends = {0, GOAL, *(step.id for step in first)}
    links = tuple(link for link in plan.links if link.producer in ends and link.consumer in ends)
    named = {link.literal.fact for link in links if link.producer == 0}
    excerpt = replace(
        plan,
        initial=tuple(fact for fact in plan.initial if fact in named),
        steps=first,
        links=links,
        orderings=tuple((i, j) for i, j in plan.orderings if i in ends and j in ends),
        bounds=(),
        bindings=(),
    )
    name, rest = format_links(excerpt).split("\n", 1)
    if len(first) == len(plan.steps):
        return f"{name}\n{rest}"
    return f"{name}\n; first {steps} of {len(plan.steps)} steps\n{rest}"


def number_of_steps(text: str) -> int | None:
    """Number of steps of the whole plan if the text is an excerpt; None if it is not."""
    match = _COUNT.search(text)
    return int(match[1]) if match else None


def _links(links: list[Link]) -> Iterator[str]:
    for link in links:
        yield f"          {link.producer:<3} -> {link.literal}"


def _matrix(plan: Plan) -> Iterator[str]:
    for row in plan.bounds:
        yield "".join(f" {'inf' if bound is None else bound:>6}" for bound in row)
