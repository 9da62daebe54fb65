"""Writes a plan as VHPOP prints it: the plain form, and the causal-link form of the paper's Figure 10."""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.planning.pddl.formula_text import format_atom, format_number
from tailor.executive.planning.plans.plan import DEFAULT_TICK_S, GOAL, Link, Plan


def format_plan(plan: Plan) -> str:
    """The plain form: `;problem`, then one line `START:(action args)` per step, with `[duration]` in durative plans.

    Args:
      plan: A finished plan.

    Returns:
      Text that `parse_plan` reads; starts are levels from 1, or seconds in durative plans.
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
    for step in plan.steps:
        lines += ["", f"Step {step.id:<3} : {format_atom(step.action)}", *_links(plan.links_to(step.id))]
    lines += ["", "Goal     : ", *_links(plan.links_to(GOAL))]
    if plan.bounds:
        lines += ["orderings = ", *_matrix(plan)]
        if plan.tick_s != DEFAULT_TICK_S:
            lines.append(f"tolerance = {plan.tick_s!r}")
    else:
        lines.append("orderings = {" + "".join(f" {i}<{j}" for i, j in plan.orderings) + " }")
    if plan.bindings:
        lines += ["bindings = ", *plan.bindings]
    return "\n".join(lines) + "\n"


def _links(links: tuple[Link, ...]) -> Iterator[str]:
    for link in links:
        yield f"          {link.producer:<3} -> {link.literal}"


def _matrix(plan: Plan) -> Iterator[str]:
    for row in plan.bounds:
        yield "".join(f" {'inf' if bound is None else bound:>6}" for bound in row)
