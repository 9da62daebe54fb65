"""Leaves out the actions of a sequence that the goal does not need.

Source: Fink & Yang, Formalizing plan justifications, 1992 (greedy justification): an action goes together with all
later ones that lose a condition by that, if the rest still reaches the goal.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

from tailor.executive.planning.forward.strips_task import StripsAction, StripsTask

PORTION = 20_000  # some ten milliseconds; a sequence of 200 actions takes one portion


def justified(sequence: Sequence[StripsAction], strips: StripsTask) -> Generator[None, None, list[StripsAction]]:
    """The sequence without unnecessary actions, in the same order; yields after every PORTION of actions tried."""
    kept = list(sequence)
    first, state, tried = 0, strips.initial, 0
    while first < len(kept):
        tried += len(kept) - first
        if tried > PORTION:
            tried = 0
            yield
        rest = _without_first(kept[first:], state, strips.goal_mask)
        if rest is None:
            state = kept[first].after(state)
            first += 1
        else:
            kept[first:] = rest
    return kept


def _without_first(actions: Sequence[StripsAction], state: int, goal_mask: int) -> list[StripsAction] | None:
    """The later actions that remain applicable without the first; None if they miss the goal."""
    kept = []
    for action in actions[1:]:
        if action.applies(state):
            kept.append(action)
            state = action.after(state)
    return None if goal_mask & ~state else kept
