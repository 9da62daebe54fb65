"""Which command arms a driver, as processes that wait for it advise people."""

from __future__ import annotations

from tailor.schemas.messages import DriverState
from tailor.schemas.reason_text import reason_text
from tailor.simnodes.driver import NOT_READY


def arming_advice(robot: str, mode: str) -> str:
    """The command that arms the driver of a robot.

    Args:
      robot: Name of the robot.
      mode: Of its driver; an e-stop is latched until people release it.
    """
    reset = " --reset" if mode == "estopped" else ""
    return f"`tailor arm {robot}{reset}` arms it"


def hardware_line(robot: str, driver: DriverState) -> str:
    """What the driver of a real robot waits for, with the command that arms it where that would not be refused."""
    line = reason_text(f"{robot} is {driver.mode}", reason_text(driver.reason, driver.detail))
    waits = driver.mode != "armed" and NOT_READY not in driver.detail
    return f"{line} ({arming_advice(robot, driver.mode)})" if waits else line
