"""Messages of the soccer robot alone: its view of the ball, and the ground truth of its simulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class BallPercept(Message):
    """Position of the ball as the camera measures it, in base_link: x ahead, y left."""

    FRAME_ID: ClassVar[str] = "base_link"

    stamp_ns: int
    x: float  # m
    y: float  # m
    var_x: float  # m^2
    var_y: float  # m^2
    cov_xy: float  # m^2


@dataclass(frozen=True, slots=True)
class SoccerGroundTruth(Message):
    """True state of robot and ball in the simulator, map frame; the executive never reads it."""

    FRAME_ID: ClassVar[str] = "map"

    stamp_ns: int
    x: float  # m
    y: float  # m
    phi: float  # rad
    v: float  # m/s
    omega: float  # rad/s
    ball_x: float  # m
    ball_y: float  # m
    ball_vx: float  # m/s
    ball_vy: float  # m/s
