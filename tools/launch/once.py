"""What ends `tailor up --once` besides a result: nothing moves any more before people arm the robot or set a goal."""

from __future__ import annotations

from collections.abc import Callable

from tailor.executive.core.modes import Mode
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.reason_text import reason_text
from tailor.tools.launch.processes import LaunchConfig


def outcome(mode: str, result: str, cause: str) -> str:
    """How the pursuit of one goal ended: its result, else the fault, in which a task has none; empty: it has not."""
    return result or (f"failed: {cause}" if mode == Mode.FAULT else "")


class OnceWatch:
    """Follows the own driver, and how often it and the executive were started."""

    def __init__(self, config: LaunchConfig, starts: Callable[[str], int]) -> None:
        """`starts`: how often a process was started, by name."""
        self._starts, self._driver = starts, config.driver
        self._stopped = self._fault = ""
        # Only a simulator's first start is armed by itself; people arm hardware, perhaps a later start of its driver.
        self._armed_start: int | None = None if config.hardware else 1

    def hear(self, driver: DriverState) -> None:
        """Take a state of the own driver."""
        if driver.mode == "armed" and self._armed_start is None:
            self._armed_start = self._starts(self._driver)
        # Until it is armed again. Hardware that was opened at the second attempt is stopped as well: people arm it yet.
        stopped = driver.mode == "estopped" or (driver.mode == "stopped" and self._armed_start is not None)
        cause = reason_text(driver.reason, driver.detail)
        self._stopped = f"failed: the driver is {driver.mode}: {cause}" if stopped else ""

    def hear_executive(self, status: ExecStatus) -> None:
        """Take a status of the own executive."""
        self._fault = outcome(status.mode, "", reason_text(status.reason, status.detail))  # until people set a goal

    def failure(self) -> str:
        """Why the run has failed, or ""."""
        if self._stopped or self._fault:
            return self._stopped or self._fault
        if self._starts("executive") > 1:
            return "failed: the executive was started again"
        if self._armed_start is not None and self._starts(self._driver) > self._armed_start:
            return "failed: the driver was started again"
        return ""
