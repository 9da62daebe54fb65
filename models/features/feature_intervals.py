"""Feature spaces in interval arithmetic: ranges of the features for boxes of arguments.

Each function is the interval form of its namesake in `features.py`; a test compares them on random boxes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from tailor.models.features.intervals import ARGUMENT_ERROR, Span, direction, length, magnitude, triangle, unsigned
from tailor.models.features.lifted_intervals import joints_lifted
from tailor.models.features.obstacle_intervals import one_obstacle
from tailor.models.features.sight_intervals import Case, Spans, may_lie_in_half, sight, wrapped
from tailor.models.features.spot_intervals import spot, spot_handle, spot_out
from tailor.models.features.straight_drive import SEEN
from tailor.models.features.straight_intervals import straight_or_bent

FeatureSpans = Callable[[Spans], tuple[Case, ...]]

AT_REST = 1e-7  # well below SAME_PLACE of features.py


def _direct(columns: Spans) -> tuple[Case, ...]:
    return (Case(columns),)


def _relative(columns: Spans) -> tuple[Case, ...]:
    x, y, phi, v, xg, yg, phig, vg = columns
    dx, dy = (xg - x).wider(ARGUMENT_ERROR), (yg - y).wider(ARGUMENT_ERROR)
    return (Case((dx, dy, phi, v, phig, vg)),)


def _projective(columns: Spans) -> tuple[Case, ...]:
    x, y, phi, v, xg, yg, phig, vg = columns
    dx, dy = xg - x, yg - y
    line = sight(x, y, xg, yg)
    to = line - phi
    known = v, vg, length(dx, dy), unsigned(to)
    left, right = may_lie_in_half(to, 0.0), may_lie_in_half(to, -np.pi)
    cases = []
    for at, beyond in wrapped(phig - line):
        cases += [Case((*known, at), left & beyond), Case((*known, -at), right & beyond)]
    return tuple(cases)


def _projective_turn(columns: Spans) -> tuple[Case, ...]:
    turn = unsigned(columns[6] - columns[2])
    return tuple(Case((*case.features, turn), case.possible) for case in _projective(columns))


def _projective_periodic(columns: Spans) -> tuple[Case, ...]:
    cases = []
    for case in _projective(columns):
        at = case.features[-1]
        cases.append(Case((*case.features, magnitude(at), triangle(at)), case.possible))
    return tuple(cases)


def _straight_drive(columns: Spans) -> tuple[Case, ...]:
    cases = []
    for case in _projective(columns[:SEEN]):
        assert case.possible is not None
        dist, to, at = case.features[2:]
        for straight, where in straight_or_bent(dist, to, at, columns[SEEN]):
            cases.append(Case((*case.features, straight), case.possible & where))
    return tuple(cases)


def _joints(columns: Spans) -> tuple[Case, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = ag - a, bg - b
    line = sight(a, b, ag, bg)
    known = length(wa, wb), length(wag, wbg), length(da, db)
    leaving = wrapped(line - _heading(wa, wb, line))
    arriving = wrapped(_heading(wag, wbg, line) - line)
    return tuple(Case((*known, to, at), first & second) for to, first in leaving for at, second in arriving)


def _joints_relative(columns: Spans) -> tuple[Case, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = (ag - a).wider(ARGUMENT_ERROR), (bg - b).wider(ARGUMENT_ERROR)
    return (Case((a, b, da, db, wa, wb, wag, wbg)),)


def _heading(wa: Span, wb: Span, line: Span) -> Span:
    """Direction of a velocity; at rest that of the line of sight."""
    moving = direction(wa, wb)
    fastest = np.maximum(magnitude(wa).upper, magnitude(wb).upper)
    rests = fastest < AT_REST
    return Span(np.where(rests, line.lower, moving.lower), np.where(rests, line.upper, moving.upper))


def _with_friction(spans: FeatureSpans) -> FeatureSpans:
    """Intervals of a space of joints that has friction as two more arguments and features."""
    return lambda columns: tuple(Case((*case.features, *columns[8:]), case.possible) for case in spans(columns[:8]))


FEATURE_SPANS: Mapping[str, FeatureSpans] = {
    "direct": _direct,
    "relative": _relative,
    "projective": _projective,
    "projective-turn": _projective_turn,
    "projective-periodic": _projective_periodic,
    "straight-drive": _straight_drive,
    "one-obstacle": one_obstacle,
    "spot": spot,
    "spot-out": spot_out,
    "spot-handle": spot_handle,
    "joints": _joints,
    "joints-relative": _joints_relative,
    "joints-lifted": joints_lifted,
    "joints-friction": _with_friction(_joints),
    "joints-relative-friction": _with_friction(_joints_relative),
    "joints-lifted-friction": _with_friction(joints_lifted),
}
