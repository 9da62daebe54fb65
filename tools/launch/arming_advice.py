"""Which command arms a driver, as processes that wait for it advise people."""

from __future__ import annotations

from collections.abc import Callable

from tailor.schemas.messages import DriverState
from tailor.schemas.reason_text import reason_text
from tailor.simnodes.driver import NOT_READY
from tailor.simnodes.reasons import Mode, Reason


def arming_advice(robot: str, mode: str, reason: str = "", detail: str = "") -> str:
    """The command that arms the driver of a robot; empty where it is armed, would refuse it, or does not hear it.

    Args:
      robot: Name of the robot.
      mode: Of its driver; an e-stop is latched until people release it.
      reason, detail: Of the mode.
    """
    if mode == Mode.ARMED or reason == Reason.SHUTDOWN or NOT_READY in detail:
        return ""
    reset = " --reset" if mode == Mode.ESTOPPED else ""
    return f"`tailor arm {robot}{reset}` arms it"


def driver_line(robot: str, driver: DriverState) -> str:
    """What a driver does or waits for, with the command that arms it where that would not be refused."""
    line = reason_text(f"{robot} is {driver.mode}", reason_text(driver.reason, driver.detail))
    advice = arming_advice(robot, driver.mode, driver.reason, driver.detail)
    return f"{line} ({advice})" if advice else line


class DriverLines:
    """What a launcher reports of its driver: a line at each change, once people have to arm it.

    A real robot is armed by people from the first start on, a simulator only once its executive's leave is gone.
    """

    def __init__(self, robot: str, is_hardware: bool, report: Callable[[str], None]) -> None:
        """`report` receives the lines."""
        self._robot, self._by_people, self._report = robot, is_hardware, report
        self._last = ""

    def hear(self, driver: DriverState, starts: int) -> None:
        """Take a state of the driver, which was started so often."""
        had_leave = starts == 1 and driver.reason in (Reason.STARTED, Reason.NONE)
        self._by_people = self._by_people or not had_leave
        line = driver_line(self._robot, driver)
        if self._by_people and line != self._last:
            self._last = line
            self._report(line)
