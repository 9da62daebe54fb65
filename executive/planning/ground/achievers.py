"""Which ground actions achieve a literal, in the order in which the search tries them.

Plans of one rank are told apart by their age alone, so every count hangs on this order. The literature leaves it open;
these are the rules under which the generated and visited plans of VHPOP 2.2.1 come out exactly.
"""

from __future__ import annotations

from collections.abc import Sequence

from tailor.executive.planning.ground.additive_heuristic import Estimates
from tailor.executive.planning.ground.ground_action import GroundAction, GroundEffect

Achiever = tuple[GroundAction, GroundEffect]

# How many achievers of all literals the table holds before it grows: primes, each about twice the last.
SIZES = (193, 389, 769, 1543, 3079, 6151, 12289, 24593, 49157, 98317, 196613, 393241, 786433, 1572869)


def achievers_of(
    actions: Sequence[GroundAction], estimates: Estimates, literals: int
) -> tuple[tuple[Achiever, ...], ...]:
    """By literal, the reachable actions with the effect that makes it true.

    Actions are entered level by level of the relaxed planning graph, within a level in grounding order. A literal's
    first achiever keeps its place, each later one goes right behind it: so they are tried newest first. Whenever the
    table grows, each literal's achievers are turned round.

    Args:
      actions: All ground actions, by number.
      estimates: They know what is reachable, and on which level.
      literals: How many there are.
    """
    table: list[list[Achiever]] = [[] for _ in range(literals)]
    reached = (actions[number] for number in estimates.reached)
    found = (
        (action, effect) for action in reached for effect in action.effects if estimates.reaches(effect.conditions)
    )
    for count, (action, effect) in enumerate(found):
        if count in SIZES:
            for own in table:
                own.reverse()
        table[effect.literal].insert(1, (action, effect))
    return tuple(tuple(own) for own in table)
