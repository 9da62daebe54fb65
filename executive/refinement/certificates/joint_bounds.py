"""Bounds of pairs of boxes of several actions; linear ones of the same model are computed in one call.

A call of the networks' bounds for 128 pairs takes half the time a pair that one for 32 takes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tailor.executive.interfaces.values import Array, Columns
from tailor.executive.refinement.certificates.boxes import Boxes
from tailor.executive.refinement.certificates.pair_bounds import PairBounds
from tailor.executive.refinement.certificates.stage_bounds import ArgumentBoxes, Duration, StageBound

Request = tuple[StageBound, Boxes, Boxes]  # n boxes of the subgoal before, and n own ones


def joint_bounds(requests: Sequence[Request]) -> list[PairBounds]:
    """Lower bounds of each request's n pairs."""
    arguments = [bound.arguments(before, own) for bound, before, own in requests]
    groups: dict[tuple[int, int], list[int]] = {}
    for i, (bound, _, _) in enumerate(requests):
        groups.setdefault((id(bound.duration), bound.stage.n_arrivals), []).append(i)
    durations: dict[int, Duration] = {}
    for group in groups.values():
        counts = [len(requests[i][2]) for i in group]
        bound = requests[group[0]][0]
        joined = _joined([arguments[i] for i in group], counts)
        durations.update(zip(group, _durations(bound, joined, counts), strict=True))
    return [
        bound.pair_bounds(before, own, arguments[i], durations[i]) for i, (bound, before, own) in enumerate(requests)
    ]


def _durations(bound: StageBound, arguments: ArgumentBoxes, counts: Sequence[int]) -> list[Duration]:
    """Lower bounds of the duration, divided into parts of these numbers of pairs."""
    ends, k_std = (arguments.lower, arguments.upper), bound.settings.k_std
    slopes: Mapping[int, Array] = {}
    if bound.is_linear:
        cost, slopes = bound.duration.linear_bound(*ends, arguments.radius, k_std)
    else:
        cost = bound.duration.lower_bound(*ends, k_std).mean(axis=0)
    parts = np.cumsum(counts)[:-1]
    by_argument = {j: np.split(slope, parts) for j, slope in slopes.items()}
    return [
        (middle, {j: slope[i] for j, slope in by_argument.items()}) for i, middle in enumerate(np.split(cost, parts))
    ]


def _joined(arguments: Sequence[ArgumentBoxes], counts: Sequence[int]) -> ArgumentBoxes:
    """All pairs of boxes, one after another."""
    if len(arguments) == 1:
        return arguments[0]
    columns = ([getattr(each, name) for each in arguments] for name in ("lower", "upper", "radius"))
    return ArgumentBoxes(*(_along_pairs(parts, counts) for parts in columns))


def _along_pairs(parts: Sequence[Columns], counts: Sequence[int]) -> Columns:
    """Each column of all parts, of these numbers of pairs."""
    total = sum(counts)
    joined: list[Array] = []
    for columns in zip(*parts, strict=True):
        column = np.empty((columns[0].shape[0], total, 1))
        end = 0
        for values, count in zip(columns, counts, strict=True):
            column[:, end : end + count] = values
            end += count
        joined.append(column)
    return tuple(joined)
