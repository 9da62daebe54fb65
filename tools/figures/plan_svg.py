"""Draws a plan as an SVG image from top to bottom: each step in a box with its conditions and who makes them true.

Lines run between the rows of boxes, and beside all boxes if they pass a row, so that none crosses a box.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from tailor.executive.planning import GOAL, Plan
from tailor.executive.planning.pddl.formula_text import format_atom, format_number
from tailor.tools.viewer.bare_orderings import bare_orderings

START = 0
_TITLE, _LINE = 7.2, 5.6  # pixels a character at 12 and 10 pixels, wide fonts included
_HEAD, _ROW, _PAD, _APART, _MARGIN = 20, 13, 6, 26, 24
_GAP, _SPREAD, _LANE = 30, 5, 9  # between rows; between lines that run beside each other: across, along


@dataclass(slots=True)
class _Box:
    """A step (or the initial state, or the goal) with the lines of text below its title, and its place."""

    title: str
    lines: list[str]
    level: int
    x: float = 0.0  # of the middle
    y: float = 0.0  # of the upper edge

    @property
    def width(self) -> float:
        return 2 * _PAD + max([len(self.title) * _TITLE, *(len(line) * _LINE for line in self.lines)])

    @property
    def height(self) -> float:
        return _HEAD + _ROW * len(self.lines) + (_PAD if self.lines else 0)

    def drawn(self) -> str:
        """Rectangle and text."""
        left = self.x - self.width / 2
        rows = "".join(
            f'<text x="{left + _PAD:g}" y="{self.y + _HEAD + _ROW * n + 10:g}" font-size="10" fill="#445">'
            f"{escape(line)}</text>"
            for n, line in enumerate(self.lines)
        )
        return (
            f'<rect x="{left:g}" y="{self.y:g}" width="{self.width:g}" height="{self.height:g}" rx="5" fill="#f4f6fa" '
            f'stroke="#334"/><text x="{left + _PAD:g}" y="{self.y + 15:g}" font-size="12">{escape(self.title)}</text>'
            f"{rows}"
        )


def to_svg(plan: Plan) -> str:
    """The plan as an SVG image: links solid, orderings that no link implies dashed.

    Lines from the initial state are drawn to the first row only: every box names the source of its conditions.

    Args:
      plan: A finished plan.

    Returns:
      A complete SVG document.
    """
    boxes = _boxes(plan)
    solid = sorted(
        {(x.producer, x.consumer) for x in plan.links if x.producer != START or boxes[x.consumer].level == 1}
    )
    edges = [*((i, j, False) for i, j in solid), *((i, j, True) for i, j in bare_orderings(plan))]
    gaps = _place(boxes, edges)
    right = max(box.x + box.width / 2 for box in boxes.values())
    paths, lanes = _paths(boxes, edges, gaps, right)
    width, height = right + _LANE * (lanes + 1) + _MARGIN, max(box.y + box.height for box in boxes.values()) + _MARGIN
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
            f'viewBox="0 0 {width:g} {height:g}" font-family="Helvetica, sans-serif">',
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
            '<path d="M0 0 8 4 0 8z" fill="context-stroke"/></marker></defs>',
            f'<rect width="{width:g}" height="{height:g}" fill="#ffffff"/>',
            *paths,
            *(box.drawn() for box in boxes.values()),
            "</svg>\n",
        ]
    )


# --- layout --------------------------------------------------------------------------------------
def _boxes(plan: Plan) -> dict[int, _Box]:
    """The boxes by step; levels by start time, or by the longest way from the initial state."""
    levels = _levels(plan)
    boxes = {START: _Box("initial state", [], 0)}
    for step in plan.steps:
        when = [f"{format_number(step.start)} s, for {format_number(step.duration)} s"] if plan.durative else []
        boxes[step.id] = _Box(f"{step.id} {format_atom(step.action)}", when, levels[step.id])
    boxes[GOAL] = _Box("goal", [], max(levels.values(), default=0) + 1)
    for link in plan.links:
        source = "from the start" if link.producer == START else f"by {link.producer}"
        boxes[link.consumer].lines.append(f"{link.literal} {source}")
    return boxes


def _levels(plan: Plan) -> dict[int, int]:
    if plan.durative:
        starts = sorted({step.start for step in plan.steps})
        return {step.id: starts.index(step.start) + 1 for step in plan.steps}
    before: dict[int, list[int]] = {step.id: [] for step in plan.steps}
    for i, j in (*plan.orderings, *((link.producer, link.consumer) for link in plan.links)):
        if i in before and j in before:
            before[j].append(i)
    levels: dict[int, int] = {}
    for step in plan.steps:  # sorted by start: what comes before has its level
        levels[step.id] = 1 + max((levels.get(i, 0) for i in before[step.id]), default=0)
    return levels


def _place(boxes: dict[int, _Box], edges: Sequence[tuple[int, int, bool]]) -> list[float]:
    """Places the boxes in rows; returns the height below each row at which its gap begins."""
    rows: list[list[_Box]] = [[] for _ in range(1 + max(box.level for box in boxes.values()))]
    for box in boxes.values():
        rows[box.level].append(box)
    width = max(sum(box.width for box in row) + _APART * (len(row) - 1) for row in rows)
    y, gaps = float(_MARGIN), []
    for n, row in enumerate(rows):
        x = _MARGIN + (width - sum(box.width for box in row) - _APART * (len(row) - 1)) / 2
        for box in row:
            box.x, box.y = x + box.width / 2, y
            x += box.width + _APART
        y += max(box.height for box in row)
        gaps.append(y)
        crossing = sum(n in (boxes[i].level, boxes[j].level - 1) for i, j, _ in edges)
        y += _GAP + _SPREAD * crossing
    return gaps


def _paths(
    boxes: dict[int, _Box], edges: Sequence[tuple[int, int, bool]], gaps: list[float], right: float
) -> tuple[list[str], int]:
    """The lines, each with its own height in the gaps it runs through, and the number of lanes beside all boxes."""
    used = [0] * len(gaps)
    ends: list[int] = []  # the level at which each lane is free again
    leaving, arriving = _Fan([i for i, _, _ in edges]), _Fan([j for _, j, _ in edges])
    paths = []
    for i, j, dashed in edges:
        a, b = boxes[i], boxes[j]
        x1, x2 = a.x + leaving.offset(i, a.width), b.x + arriving.offset(j, b.width)
        route = f"M{x1:g} {a.y + a.height:g} V{_height(gaps, used, a.level):g} "
        if b.level - a.level > 1:
            lane = next((n for n, end in enumerate(ends) if end <= a.level), len(ends))
            ends[lane : lane + 1] = [b.level]
            route += f"H{right + _LANE * (lane + 1):g} V{_height(gaps, used, b.level - 1):g} "
        style = 'stroke="#999999" stroke-dasharray="5 4"' if dashed else 'stroke="#2266aa"'
        title = f"{i} before {j}" if dashed else f"{a.title} for {b.title}"
        paths.append(
            f'<path d="{route}H{x2:g} V{b.y:g}" fill="none" {style} marker-end="url(#tip)">'
            f"<title>{escape(title)}</title></path>"
        )
    return paths, len(ends)


def _height(gaps: list[float], used: list[int], row: int) -> float:
    """The next free height in the gap below a row."""
    used[row] += 1
    return gaps[row] + 8 + _SPREAD * used[row]


class _Fan:
    """Spreads the ends of lines along the edges of their boxes."""

    def __init__(self, ends: Sequence[int]) -> None:
        self._count = {end: ends.count(end) for end in ends}
        self._next = dict.fromkeys(ends, 0)

    def offset(self, end: int, width: float) -> float:
        """Offset of the next line from the middle of its box."""
        self._next[end] += 1
        return (self._next[end] / (self._count[end] + 1) - 0.5) * 0.8 * width
