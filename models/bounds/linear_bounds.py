"""Linear lower bounds of networks over boxes of arguments, for the mean over several displaced copies of each box.

The bound is linear in the arguments: what a subgoal's value costs one action and saves the next one cancels. All copies
of a box share one relaxation of the networks, over the smallest box of features that holds them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tailor.models.bounds.feature_boxes import boxes_between
from tailor.models.bounds.fragments import Columns, corners, fragments_of
from tailor.models.bounds.network_bounds import NetworkBounds
from tailor.models.features.intervals import Array, Span
from tailor.models.features.linear_pieces import LINEAR_PIECES, Piece
from tailor.models.features.sight_intervals import Spans

LEAST_WIDTH = 1e-3  # of a feature in a piece; all pieces of a pair of points weigh the same


def linear_bound(
    networks: NetworkBounds,
    space: str,
    lower: Columns,
    upper: Columns,
    radius: Columns,
    rest: Callable[[Spans], Array] | None = None,
) -> tuple[Array, dict[int, Array]]:
    """Lower bound of the mean over copies of pairs of boxes.

    Args:
      networks: The networks.
      space: Their feature space, one of LINEAR_PIECES.
      lower: Lower ends of each argument in each copy; the arrays broadcast to (copies, n, m).
      upper: Upper ends.
      radius: Half of each argument's range before it was displaced.
      rest: A lower bound of what is added to the networks' mean, of the shape of the features that it is given.

    Returns:
      The bound in the middle of each pair, (n, m), and its slope by argument, (n, m).
    """
    shape = np.broadcast_shapes(*(each.shape for each in (*lower, *upper)))
    pieces = tuple(LINEAR_PIECES[space](tuple(map(Span, lower, upper))))
    fragments = fragments_of(pieces, lower, upper, radius, shape)
    hull, pairs, count = fragments.hull, fragments.pairs, shape[1] * shape[2]
    constant, factor = _plane(networks, pieces[0], *hull)
    # a pair in several pieces has the slopes of each in proportion to its size
    weight = np.prod(np.where(fragments.sign == 0, 1.0, LEAST_WIDTH + hull[1] - hull[0]), axis=0)
    weights = np.bincount(pairs, weight, count)
    slopes = np.array([np.bincount(pairs, each, count) for each in weight * fragments.sign * factor]) / weights
    terms = zip(pieces[0].terms, (slope.reshape(shape[1:]) for slope in slopes), strict=True)
    by_argument = {term.argument: slope for term, slope in terms if term.argument is not None}
    least = constant + fragments.least(factor, slopes[:, pairs])
    reach = sum(np.abs(slope) * radius[j][0] for j, slope in by_argument.items())
    least = np.minimum(least, networks.high - np.ravel(reach)[pairs])  # no copy exceeds the end of the networks' range
    if rest is not None:
        least += rest(fragments.features(pieces[0]))[..., 0]
    lowest = np.full((count, shape[0]), np.inf)
    np.minimum.at(lowest, pairs, np.where(fragments.possible, least, np.inf).T)
    return lowest.mean(axis=1).reshape(shape[1:]), by_argument


def _plane(networks: NetworkBounds, piece: Piece, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Constants, (p,), and factors of the terms, (t, p), of the bound over boxes of features, (t, p)."""
    if piece.curve is None:
        constant, slopes = networks.plane(boxes_between(lower.astype(np.float32), upper.astype(np.float32)))
        return constant.astype(np.float64), slopes.astype(np.float64)
    last = len(lower) - 1
    angles = corners(lower[last], upper[last])
    curve = np.stack([angles, *piece.curve(angles)])
    ends = lower[:last].astype(np.float32), upper[:last].astype(np.float32)
    constant, slopes = networks.plane(boxes_between(*ends, curve.astype(np.float32)))
    factor = slopes[: last + 1].astype(np.float64)
    bend = (slopes[last:, None] * curve).sum(axis=0)  # along the curve, replaced by its chord
    width = angles[-1] - angles[0]
    factor[last] = np.divide(bend[-1] - bend[0], width, out=np.zeros_like(width), where=width > 0)
    return constant + (bend - factor[last] * angles).min(axis=0), factor
