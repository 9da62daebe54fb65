"""Messages of the soccer robot alone: its view of ball and opponents, and the ground truth of its simulator."""

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


@dataclass(frozen=True, slots=True)
class BallTruth(Message):
    """True state of a second ball in the simulator, map frame; the executive never reads it."""

    FRAME_ID: ClassVar[str] = "map"

    stamp_ns: int
    x: float  # m
    y: float  # m
    vx: float  # m/s
    vy: float  # m/s


@dataclass(frozen=True, slots=True)
class OpponentPercept:
    """One opponent as the camera measures it: centre and radius of a standing cylinder, in base_link."""

    x: float  # m
    y: float  # m
    radius_m: float
    var_x: float  # m^2
    var_y: float  # m^2
    cov_xy: float  # m^2


@dataclass(frozen=True, slots=True)
class OpponentPercepts(Message):
    """All opponents that the camera found in one picture; none is a measurement, too."""

    FRAME_ID: ClassVar[str] = "base_link"

    stamp_ns: int
    opponents: tuple[OpponentPercept, ...] = ()


@dataclass(frozen=True, slots=True)
class Opponent:
    """A standing cylinder on the field."""

    x: float  # m
    y: float  # m
    radius_m: float


@dataclass(frozen=True, slots=True)
class OpponentsTruth(Message):
    """True places of the opponents in the simulator, map frame; the executive never reads them."""

    FRAME_ID: ClassVar[str] = "map"

    stamp_ns: int
    touched: bool  # the robot touched one since the last message
    opponents: tuple[Opponent, ...] = ()
