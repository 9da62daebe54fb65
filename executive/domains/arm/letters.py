"""Letters and words as scenarios: strokes of a font, put into joint space, as a PDDL problem with places.

`letter-A` to `letter-Z` fill the page; `word-TAILOR` writes letters side by side, smaller; `stops-TAILOR` comes to rest
at every waypoint, as the upper row of the paper's Figure 13 (b); `ring-TAILOR` goes on at its first waypoint after the
last one, so that goals like (at p3) never come to an end.
"""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import pairwise

import numpy as np

from tailor.executive.domains.arm.action_library import fastest_radps
from tailor.executive.interfaces.domain import Scenario
from tailor.schemas.errors import UsageError

Point = tuple[float, float]  # rad: pan, lift

WIDTH, HEIGHT = 1.0, 1.4  # of a capital in the font's units
GAP = 0.45  # between two letters, in the same units
PAGE_WIDTH_RAD = 2.3
LETTER_RAD = 0.8  # a letter alone: one unit of the font
SIZES = (0.9, 1.05)  # range of the scale, drawn by the seed
HOME = (-0.85, -0.7)  # where the arm rests before it writes
HOME_RANGE_RAD = 0.1
KINDS = ("letter", "word", "stops", "ring")
MAX_LETTERS = 12  # with more, letters become too small to read


@dataclass(frozen=True, slots=True)
class Writing:
    """A text to write: the start of the arm, and the stroke of each letter."""

    text: str
    home: Point
    strokes: tuple[tuple[Point, ...], ...]


@cache
def font() -> dict[str, tuple[Point, ...]]:
    """The strokes by letter, in the font's units."""
    table = tomllib.loads(resources.files(__package__).joinpath("letters.toml").read_text(encoding="utf-8"))
    return {letter: tuple((float(x), float(y)) for x, y in stroke) for letter, stroke in table.items()}


def scenarios() -> list[str]:
    """Names of the scenarios of single letters; those of words are not listed."""
    return [f"letter-{letter}" for letter in sorted(font())]


def is_word(text: str) -> bool:
    """Whether a text can be written: 1 to MAX_LETTERS capitals."""
    return re.fullmatch(f"[A-Z]{{1,{MAX_LETTERS}}}", text) is not None


def load_scenario(scenario: str, rng: np.random.Generator) -> tuple[Scenario, dict[str, float]]:
    """Load a scenario with size and start drawn from `rng`, and the start state of the body (rad, rad/s).

    Raises:
      UsageError: No such scenario.
    """
    kind, _, text = scenario.partition("-")
    if kind not in KINDS or not is_word(text) or (kind == "letter" and len(text) > 1):
        raise UsageError(
            f"no scenario {scenario!r} in arm, expected letter-A to letter-Z, "
            f"or word-, stops- or ring- and 1 to {MAX_LETTERS} capitals"
        )
    writing = _laid_out(text, rng)
    a, b = writing.home
    return _scenario(scenario, writing, kind), {"a": a, "wa": 0.0, "b": b, "wb": 0.0}


def _laid_out(text: str, rng: np.random.Generator) -> Writing:
    """Letters side by side about the middle of the page, with the size and the start that `rng` draws."""
    size, off_a, off_b = rng.uniform(*SIZES), *rng.uniform(-HOME_RANGE_RAD, HOME_RANGE_RAD, 2)
    wide = len(text) * WIDTH + (len(text) - 1) * GAP
    unit = float(size) * min(LETTER_RAD, PAGE_WIDTH_RAD / max(SIZES) / wide)
    strokes = []
    for place, letter in enumerate(text):
        left, low = place * (WIDTH + GAP) - wide / 2, -HEIGHT / 2
        strokes.append(tuple((unit * (left + x), unit * (low + y)) for x, y in font()[letter]))
    return Writing(text, (HOME[0] + float(off_a), HOME[1] + float(off_b)), tuple(strokes))


def _scenario(name: str, writing: Writing, kind: str) -> Scenario:
    """All strokes in one chain of waypoints p1, p2, …; the arm must come to rest at the last, at all or nowhere."""
    points = [point for stroke in writing.strokes for point in stroke]
    labels = [f"p{k}" for k in range(1, len(points) + 1)]
    ways = [math.dist(one, other) for one, other in pairwise([writing.home, *points])]
    last = math.dist(points[-1], points[0]) if kind == "ring" else ways[-1]
    places = {}
    for label, (a, b), before, after in zip(labels, points, ways, [*ways[1:], last], strict=True):
        places[label] = {"a": a, "b": b, "fastest": fastest_radps(min(before, after))}
    for label in {"stops": labels, "ring": []}.get(kind, labels[-1:]):
        places[label] |= {"wa": 0.0, "wb": 0.0}
    counts = tuple((letter, len(stroke)) for letter, stroke in zip(writing.text, writing.strokes, strict=True))
    return Scenario(name, _problem(labels, kind == "ring"), places, {"letters": counts, "events": ()})


def _problem(labels: list[str], closed: bool) -> str:
    ways = [*pairwise(["home", *labels]), *([(labels[-1], labels[0])] if closed else [])]
    steps = " ".join(f"(next {a} {b})" for a, b in ways)
    return f"""(define (problem writing)
  (:domain arm)
  (:objects home {" ".join(labels)})
  (:init (at home) {steps})
  (:goal (drawn {labels[-1]})))
"""
