"""Draws a plan's partial order: causal links with their literals, and orderings that no link implies."""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

from tailor.executive.planning import GOAL, Plan
from tailor.executive.planning.pddl.formula_text import format_atom, format_number

_COLUMN, _ROW, _WIDTH, _HEIGHT, _MARGIN = 330, 84, 190, 40, 30  # pixels; literals are between the columns
_LINE = 11  # pixels from one literal to the next
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


# --- SVG -----------------------------------------------------------------------------------------
def to_svg(plan: Plan) -> str:
    """The plan as an SVG image: one column per start time, links solid, orderings dashed.

    Args:
      plan: A finished plan.

    Returns:
      A complete SVG document.
    """
    places = _places(plan)
    arrows = [_Arrow(*_ends(places, *ends), tuple(literals)) for ends, literals in _links(plan).items()]
    arrows += [_Arrow(*_ends(places, *ends), (f"{ends[0]} before {ends[1]}",), True) for ends in bare_orderings(plan)]
    width = max(x for x, _ in places.values()) + _WIDTH + _MARGIN
    top = min([0.0] + [arrow.top - _MARGIN for arrow in arrows])
    height = max([y + _HEIGHT for _, y in places.values()] + [arrow.bottom for arrow in arrows]) + _MARGIN - top
    times = {step.id: format_number(step.start) for step in plan.steps}
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height:g}" '
            f'viewBox="0 {top:g} {width} {height:g}" font-family="Helvetica, sans-serif">',
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
            '<path d="M0 0 8 4 0 8z" fill="context-stroke"/></marker></defs>',
            f'<rect y="{top:g}" width="{width}" height="{height:g}" fill="#ffffff"/>',
            *(arrow.curve() for arrow in arrows),
            *(
                _box(*places[step], label, f"t = {times[step]}" if step in times else "")
                for step, label in _labels(plan).items()
            ),
            *(arrow.labels() for arrow in arrows if not arrow.dashed),  # last, so that no box hides them
            "</svg>\n",
        ]
    )


def _places(plan: Plan) -> dict[int, tuple[int, int]]:
    """The upper left corner of each box: columns by start time, rows in the order of the steps."""
    starts = sorted({step.start for step in plan.steps})
    rows = [0] * (len(starts) + 2)
    places = {_START: (_MARGIN, _MARGIN), GOAL: (_MARGIN + (len(starts) + 1) * _COLUMN, _MARGIN)}
    for step in plan.steps:
        column = starts.index(step.start) + 1
        places[step.id] = (_MARGIN + column * _COLUMN, _MARGIN + rows[column] * _ROW)
        rows[column] += 1
    return places


def _ends(places: dict[int, tuple[int, int]], a: int, b: int) -> tuple[int, int, int, int]:
    """From the right side of one box to the left side of another."""
    (x1, y1), (x2, y2) = places[a], places[b]
    return x1 + _WIDTH, y1 + _HEIGHT // 2, x2, y2 + _HEIGHT // 2


def _box(x: int, y: int, label: str, time: str) -> str:
    middle = x + _WIDTH / 2
    return (
        f'<rect x="{x}" y="{y}" width="{_WIDTH}" height="{_HEIGHT}" rx="6" fill="#f4f6fa" stroke="#334"/>'
        f'<text x="{middle}" y="{y + (18 if time else 25)}" font-size="12" text-anchor="middle">{escape(label)}</text>'
        f'<text x="{middle}" y="{y + 33}" font-size="10" fill="#667" text-anchor="middle">{escape(time)}</text>'
    )


@dataclass(frozen=True, slots=True)
class _Arrow:
    """A curve with labels; it hangs lower the more columns it skips."""

    x1: int
    y1: int
    x2: int
    y2: int
    lines: tuple[str, ...]
    dashed: bool = False

    @property
    def middle(self) -> float:
        """Height of the middle: half-way, or between two rows of boxes if it skips columns."""
        skipped = (self.x2 - self.x1) // _COLUMN
        if skipped < 1:
            return (self.y1 + self.y2) / 2
        return max(self.y1, self.y2) + 0.64 * _ROW + _ROW * round(1.6 * math.sqrt(skipped) - 1.6)

    @property
    def top(self) -> float:
        """Height of the first label."""
        return self.middle - 4 - _LINE * (len(self.lines) - 1)

    @property
    def bottom(self) -> float:
        """Height of the lowest point."""
        return max(self.y1, self.y2, self.middle) + _LINE

    def curve(self) -> str:
        """The line, with its labels as tooltip."""
        style = 'stroke="#999999" stroke-dasharray="5 4"' if self.dashed else 'stroke="#2266aa"'
        bow = (self.middle - (self.y1 + self.y2) / 2) / 0.75  # offset of the two control points
        x, y1, y2 = (self.x1 + self.x2) / 2, self.y1 + bow, self.y2 + bow
        return (
            f'<path d="M{self.x1} {self.y1} C{x} {y1:g} {x} {y2:g} {self.x2} {self.y2}" fill="none" {style} '
            f'marker-end="url(#tip)"><title>{escape(" ".join(self.lines))}</title></path>'
        )

    def labels(self) -> str:
        """The literals, one above the other, at the middle of the line, with a white outline."""
        return "".join(
            f'<text x="{(self.x1 + self.x2) / 2}" y="{self.top + n * _LINE:g}" font-size="9" fill="#2266aa" '
            f'text-anchor="middle" stroke="#ffffff" stroke-width="3" paint-order="stroke">{escape(line)}</text>'
            for n, line in enumerate(self.lines)
        )
