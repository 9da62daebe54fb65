"""One row of the table of topics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tailor.schemas.messages import ArmRequest, DriverState, Message

Priority = Literal["real_time", "interactive_high", "data"]
Source = Literal["driver", "executive", "people", "simulator", "scene", "player", "launcher"]


@dataclass(frozen=True, slots=True)
class Topic:
    """One row of the table; `{robot}` in a key is a placeholder for the robot's name."""

    key: str
    type: type[Message]  # in the table of a package with `messages` also the name of one of its files, e.g. "Grip"
    rate_hz: float  # 0: on demand or on change
    source: Source
    fresh_s: float | None = None  # a message older than this is stale; None: never
    priority: Priority = "data"
    recorded: bool = True
    max_bytes: int = 4096

    @property
    def drives(self) -> bool:
        """Whether it moves, arms or stops a robot."""
        return self.priority == "real_time" or self.type is ArmRequest

    @property
    def playable(self) -> bool:
        """Whether a recording of it may be published beside robots: it neither drives one nor confirms its stop."""
        return not self.drives and self.type is not DriverState
