"""What an observer knows of one driver. Pure."""

from __future__ import annotations

from collections.abc import Collection

from tailor.schemas.messages import DriverState
from tailor.schemas.topics import STALE_S
from tailor.tools.status.picture import DriverView


class DriverRecord:
    """The newest state of a driver, and how often it has started anew."""

    def __init__(self) -> None:
        self._state: DriverState | None = None
        self._at_ns = 0
        self._restarts = 0

    def update(self, state: DriverState, now_ns: int) -> None:
        """Take a state; another epoch is another start of the driver."""
        if self._state is not None and self._state.epoch != state.epoch:
            self._restarts += 1
        self._state, self._at_ns = state, now_ns

    def view(self, robot: str, now_ns: int, executives: Collection[str]) -> DriverView:
        """The driver at `now_ns`; `executives` are the senders of those that are alive."""
        state = self._state
        assert state is not None, "a record begins with a state"
        age_s = max(0, now_ns - self._at_ns) / 1e9
        return DriverView(
            robot=robot,
            age_s=round(age_s, 3),
            silent=age_s > STALE_S,
            mode=state.mode,
            reason=state.reason,
            detail=state.detail,
            epoch=state.epoch,
            restarts=self._restarts,
            armed_sender=state.armed_sender,
            armed_for=_armed_for(state.armed_sender, executives),
            accepted=state.accepted,
            refused=dict(zip(state.refused_reasons, state.refused_counts, strict=False)),
        )


def _armed_for(sender: str, executives: Collection[str]) -> str:
    if not sender:
        return ""
    return "executive" if sender in executives else "absent"
