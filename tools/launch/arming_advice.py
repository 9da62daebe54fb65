"""Which command arms a driver, as processes that wait for it advise people."""

from __future__ import annotations


def arming_advice(robot: str, mode: str) -> str:
    """The command that arms the driver of a robot.

    Args:
      robot: Name of the robot.
      mode: Of its driver; an e-stop is latched until people release it.
    """
    reset = " --reset" if mode == "estopped" else ""
    return f"`tailor arm {robot}{reset}` arms it"
