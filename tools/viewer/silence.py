"""Notes when the executive or the driver falls silent. Pure: every call receives the time."""

from __future__ import annotations

from tailor.schemas.messages import DriverState, ExecStatus, Message
from tailor.schemas.topics import STALE_S
from tailor.tools.viewer.event_fields import Fields

PARTS: dict[type[Message], str] = {ExecStatus: "executive", DriverState: "driver"}  # by what they publish at 10 Hz


class Silence:
    """Which parts of a run that were heard once are silent now; a state that they published is true no longer."""

    def __init__(self) -> None:
        self._heard_s: dict[str, float] = {}  # by part: its last message
        self._silent: Fields = {}

    def note(self, message: Message, at_s: float) -> None:
        """Take a message of the run."""
        part = PARTS.get(type(message))
        if part is not None:
            self._heard_s[part] = at_s

    def change(self, at_s: float) -> Fields | None:
        """Silent parts, each with the time of its last message, seconds; None if they are the same as before."""
        silent = {part: round(heard_s, 3) for part, heard_s in self._heard_s.items() if at_s - heard_s > STALE_S}
        if silent == self._silent:
            return None
        self._silent = silent
        return silent
