"""Which fault hits which system when, drawn from a seed. Pure.

Memory can only be measured in processes that live for long, and many faults end one. So a soak of at least
`MEASURED_MIN` minutes has three parts: at its begin and at its end any fault may come, and process faults come first;
between them all processes live on, under all other faults. The middle begins with the faults that every process meets
twice before it is measured: those for which the bus starts threads and fills pools, which then stay. A shorter soak
draws any fault at any time, and measures no slope. Faults are drawn like cards: none comes twice before all have come
once.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

MEASURED_MIN = 40.0
BEGIN_MIN, END_MIN = 12.0, 10.0  # of a soak that measures slopes
PHASE = (0.1, 0.4)  # of a period: when its fault comes, so that there is time to recover


@dataclass(frozen=True, slots=True)
class Planned:
    """A fault to come."""

    at_s: float  # since the start of the soak
    fault: str
    robot: str


def schedule(
    seed: int,
    minutes: float,
    every_s: float,
    robots: Sequence[str],
    harmless: Sequence[str],
    deadly: Sequence[str],
    settling: Sequence[str] = (),
) -> list[Planned]:
    """One fault for each period.

    Args:
      seed: Seed of all draws.
      minutes: Duration of the soak.
      every_s: Period, s.
      robots: Names of the systems; they take turns, in random order.
      harmless: Faults that let all processes live.
      deadly: Faults that end one.
      settling: Faults that come to every robot as soon as all processes are to live on.
    """
    draw = random.Random(seed)
    hands = {"harmless": _cards(draw, harmless), "deadly": _cards(draw, deadly)}
    hands["any"] = _cards(draw, [*harmless, *deadly])
    victims = _cards(draw, robots)
    firsts = draw.sample(pairs := list(product(settling, robots)), len(pairs))
    count = max(1, int(minutes * 60 / every_s))
    planned = []
    for number in range(count):
        at_s = (number + draw.uniform(*PHASE)) * every_s
        hand = _hand(at_s / 60, minutes)
        fault, robot = firsts.pop() if hand == "harmless" and firsts else (next(hands[hand]), next(victims))
        planned.append(Planned(at_s, fault, robot))
    return planned


def _hand(at_min: float, minutes: float) -> str:
    if minutes < MEASURED_MIN:
        return "any"
    return "harmless" if BEGIN_MIN <= at_min < minutes - END_MIN else "deadly"


def _cards(draw: random.Random, cards: Sequence[str]) -> Iterator[str]:
    """Endless: all cards in random order, then all in another."""
    while True:
        yield from draw.sample(list(cards), len(cards))
