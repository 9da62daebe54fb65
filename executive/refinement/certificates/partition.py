"""How a proof partitions the ranges of the free parameters into boxes, by what its bounds cost."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Partition:
    """Numbers of boxes, and the order of work."""

    initial_splits: int  # before the first bounds
    max_split_boxes: int  # of a subgoal at a time
    min_pieces: int  # that these are split into
    goals_pct: tuple[float, ...] = ()  # gaps that are proven first: pairs that do not matter for them wait


ONE = Partition(6, 12, 48)  # without pairs an iteration costs more than its boxes
PAIRS = Partition(4, 4, 16)


def partition(subgoals: int, linear: bool) -> Partition:
    """Partition for a number of subgoals with free parameters; `linear`: all their bounds are linear."""
    if subgoals == 1:
        return ONE
    return Partition(3, 4, 8, (5.0, 2.0)) if linear else PAIRS
