"""Achievers of each literal, in the order in which the search tries them.

Plans of equal rank differ by their age alone, so every count depends on this order. The literature leaves it open.
With these rules the numbers of generated and visited plans equal those of VHPOP 2.2.1.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

from tailor.executive.planning.ground.additive_heuristic import PORTION, Estimates
from tailor.executive.planning.ground.ground_action import GroundAction, GroundEffect

Achiever = tuple[GroundAction, GroundEffect]

# Numbers of achievers, over all literals, at which the table grows: primes, each about twice the one before.
SIZES = (193, 389, 769, 1543, 3079, 6151, 12289, 24593, 49157, 98317, 196613, 393241, 786433, 1572869)


def achievers_of(
    actions: Sequence[GroundAction], estimates: Estimates, literals: int
) -> Generator[None, None, tuple[tuple[Achiever, ...], ...]]:
    """The reachable actions with an effect that makes a literal true, by literal.

    Actions are entered level by level of the relaxed planning graph, within a level in grounding order. A literal's
    first achiever keeps its place; each later one is inserted right behind it. Whenever the table grows, the list of
    each literal is reversed. Yields after every PORTION of effects, and returns the table.

    Args:
      actions: All ground actions, by number.
      estimates: Reachable actions by level.
      literals: Number of literals.
    """
    table: list[list[Achiever]] = [[] for _ in range(literals)]
    reached = (actions[number] for number in estimates.reached)
    entries = (
        (action, effect) for action in reached for effect in action.effects if estimates.reaches(effect.conditions)
    )
    for count, (action, effect) in enumerate(entries):
        if count % PORTION == PORTION - 1:
            yield
        if count in SIZES:
            for achievers in table:
                achievers.reverse()
        table[effect.literal].insert(1, (action, effect))
    return tuple(tuple(achievers) for achievers in table)
