"""A plan's partial order as a Graphviz graph: causal links with their literals, orderings that no link implies."""

from __future__ import annotations

from tailor.executive.planning import GOAL, Plan
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.tools.viewer.bare_orderings import bare_orderings

_START = 0


def _links(plan: Plan) -> dict[tuple[int, int], list[str]]:
    """The literals of the causal links by producer and consumer."""
    links: dict[tuple[int, int], list[str]] = {}
    for link in plan.links:
        links.setdefault((link.producer, link.consumer), []).append(str(link.literal))
    return links


def _labels(plan: Plan) -> dict[int, str]:
    return {_START: "initial state", **{s.id: f"{s.id} {format_atom(s.action)}" for s in plan.steps}, GOAL: "goal"}


def to_dot(plan: Plan) -> str:
    """The plan as a Graphviz graph: solid arrows are causal links, dashed ones orderings.

    Args:
      plan: A finished plan.

    Returns:
      Text in the DOT language.
    """

    def name(step: int) -> str:
        return "goal" if step == GOAL else f"s{step}"

    lines = [f"digraph {_quoted(plan.problem)} {{", "  rankdir=LR; node [shape=box, fontname=Helvetica];"]
    lines += [f"  {name(step)} [label={_quoted(label)}];" for step, label in _labels(plan).items()]
    for (producer, consumer), literals in _links(plan).items():
        label = _quoted("\n".join(literals))
        lines.append(f"  {name(producer)} -> {name(consumer)} [label={label}, fontsize=10];")
    lines += [f"  {name(i)} -> {name(j)} [style=dashed, color=gray50];" for i, j in bare_orderings(plan)]
    return "\n".join([*lines, "}"]) + "\n"


def _quoted(text: str) -> str:
    """A Graphviz string; escapes special characters."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
