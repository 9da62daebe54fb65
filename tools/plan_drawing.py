"""Draws a plan's partial order: causal links with their literals, and the orderings that no link explains."""

from __future__ import annotations

from html import escape

from executive.planning import GOAL, Plan
from executive.planning.vhpop_text import atom, number

_COLUMN, _ROW, _WIDTH, _HEIGHT, _MARGIN = 250, 84, 190, 40, 30  # pixels
_START = 0


def bare_orderings(plan: Plan) -> list[tuple[int, int]]:
    """The orderings that neither a causal link nor two other orderings imply."""
    pairs = set(plan.orderings)
    linked = {(link.producer, link.consumer) for link in plan.links}
    steps = [step.id for step in plan.steps]
    return sorted(
        (i, j) for i, j in pairs if (i, j) not in linked and not any((i, k) in pairs and (k, j) in pairs for k in steps)
    )


def _links(plan: Plan) -> dict[tuple[int, int], list[str]]:
    """The literals of the causal links by producer and consumer."""
    links: dict[tuple[int, int], list[str]] = {}
    for link in plan.links:
        links.setdefault((link.producer, link.consumer), []).append(str(link.literal))
    return links


def _labels(plan: Plan) -> dict[int, str]:
    return {_START: "initial state", **{s.id: f"{s.id} {atom(s.action)}" for s in plan.steps}, GOAL: "goal"}


def to_dot(plan: Plan) -> str:
    """The plan as a Graphviz graph: solid arrows are causal links, dashed ones orderings."""

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
    """A string of Graphviz, whatever characters the names have."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


# --- SVG -----------------------------------------------------------------------------------------
def to_svg(plan: Plan) -> str:
    """The plan as a picture of its own: a column per start time, links solid, orderings dashed."""
    places = _places(plan)
    width = max(x for x, _ in places.values()) + _WIDTH + _MARGIN
    height = max(y for _, y in places.values()) + _HEIGHT + 2 * _MARGIN
    times = {step.id: number(step.start) for step in plan.steps}
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="Helvetica, sans-serif">',
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path d="M0 0 8 4 0 8z" fill="context-stroke"/></marker></defs>',
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    for ends, literals in _links(plan).items():
        parts.append(_arrow(places, *ends, 'stroke="#2266aa"', " ".join(literals)))
    for ends in bare_orderings(plan):
        parts.append(_arrow(places, *ends, 'stroke="#999999" stroke-dasharray="5 4"', f"{ends[0]} before {ends[1]}"))
    for step, label in _labels(plan).items():
        parts.append(_box(*places[step], label, f"t = {times[step]}" if step in times else ""))
    return "\n".join([*parts, "</svg>"]) + "\n"


def _places(plan: Plan) -> dict[int, tuple[int, int]]:
    """The upper left corner of each box: columns by start time, rows in the order of the steps."""
    starts = sorted({step.start for step in plan.steps})
    rows = [0] * (len(starts) + 2)
    places = {_START: (_MARGIN, _MARGIN), GOAL: (_MARGIN + (len(starts) + 1) * _COLUMN, _MARGIN)}
    for step in plan.steps:
        column = starts.index(step.start) + 1
        places[step.id] = (_MARGIN + column * _COLUMN, _MARGIN + rows[column] * _ROW + (column % 2) * _ROW // 3)
        rows[column] += 1
    return places


def _box(x: int, y: int, label: str, below: str) -> str:
    return (
        f'<rect x="{x}" y="{y}" width="{_WIDTH}" height="{_HEIGHT}" rx="6" fill="#f4f6fa" stroke="#334"/>'
        f'<text x="{x + _WIDTH / 2}" y="{y + 25}" font-size="12" text-anchor="middle">{escape(label)}</text>'
        f'<text x="{x}" y="{y + _HEIGHT + 13}" font-size="10" fill="#667">{escape(below)}</text>'
    )


def _arrow(places: dict[int, tuple[int, int]], a: int, b: int, style: str, title: str) -> str:
    """A curve from the right side of one box to the left side of another, bowed when it skips columns."""
    (x1, y1), (x2, y2) = places[a], places[b]
    x1, y1, y2 = x1 + _WIDTH, y1 + _HEIGHT // 2, y2 + _HEIGHT // 2
    bow = _ROW * max(0, (x2 - x1) // _COLUMN)
    middle = (x1 + x2) / 2
    text = (
        f'<text x="{middle}" y="{(y1 + y2) / 2 + 0.75 * bow - 4}" font-size="9" fill="#2266aa" text-anchor="middle">'
        f"{escape(title)}</text>"
        if "dasharray" not in style
        else ""
    )
    return (
        f'<path d="M{x1} {y1} C{middle} {y1 + bow} {middle} {y2 + bow} {x2} {y2}" fill="none" {style} '
        f'marker-end="url(#tip)"><title>{escape(title)}</title></path>{text}'
    )
