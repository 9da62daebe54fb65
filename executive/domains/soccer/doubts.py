"""Percepts by which a ball would be elsewhere at once: something else was taken for it, or somebody moved it."""

from __future__ import annotations

from collections.abc import Callable

from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.domains.soccer.belief import BALL2, SoccerBelief


def _begun_anew(before: BallTrack | None, after: BallTrack | None) -> bool:
    """Whether a percept began another track: one that is fused leaves less variance than there was."""
    return before is not None and after is not None and after.variance > before.variance


def _ball(before: SoccerBelief, after: SoccerBelief) -> bool:
    return _begun_anew(before.ball, after.ball)


def _ball2(before: SoccerBelief, after: SoccerBelief) -> bool:
    return _begun_anew(before.ball2, after.ball2)


DOUBTS: dict[str, Callable[[SoccerBelief, SoccerBelief], bool]] = {"ball": _ball, BALL2: _ball2}
