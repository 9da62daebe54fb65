"""Percepts that are no measurements: of balls and opponents farther away than any field is long."""

from __future__ import annotations

import math

from tailor.schemas.messages import Message
from tailor.schemas.messages.soccer import BallPercept, OpponentPercepts

FAR_M = 30.0  # more than the diagonal of the largest fields on which robots play, 22 m by 14 m


def fault(message: Message) -> str:
    """Why a message is no measurement, e.g. "has a ball 80 m away"; empty if it is one."""
    if isinstance(message, BallPercept):
        return _too_far("a ball", message.x, message.y)
    if isinstance(message, OpponentPercepts):
        return next((far for each in message.opponents if (far := _too_far("an opponent", each.x, each.y))), "")
    return ""


def _too_far(what: str, x: float, y: float) -> str:
    distance_m = math.hypot(x, y)
    return f"has {what} {distance_m:g} m away" if distance_m > FAR_M else ""
