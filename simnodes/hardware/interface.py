"""Base class of a robot's hardware: subclass it, and `tailor driver mypackage:MyRobot` makes a driver of it.

The driver around it holds everything that does not differ between robots: guard, arming, e-stop, epochs, watchdogs,
state and its reasons. A subclass opens a device, reads it, writes to it and closes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from tailor.schemas.messages import Message


class Hardware:
    """A robot's hardware.

    Any exception in a method is a fault: the driver stops the robot, publishes the exception's text as the reason,
    calls `close`, and later `open` again. A method that takes longer than its time limit is a fault as well.

    Attributes:
      robot: Name of the robot; its package declares command, axes, limits and sensors in `driver.toml`.
      open_s, read_s, write_s: Time limits of the methods.
      notice: What people should know although the robot can be driven, e.g. that a localiser is silent; it is printed,
        and stands in the detail of the driver's state. Looked at after each `read`.
      write_hz: Rate at which `write` is called; a new set-point is written at the next period of 10 ms.
    """

    robot: ClassVar[str] = ""
    open_s: float = 10.0
    read_s: float = 0.5
    write_s: float = 0.2
    write_hz: float = 50.0
    notice: str = ""

    def open(self) -> None:
        """Connect to the device, at start-up and after each fault. The robot must not move."""

    def read(self) -> Mapping[str, Message]:
        """Wait for the next measurements, shorter than `read_s`.

        Returns:
          New measurements by topic, e.g. `{"odom": Odometry(...)}`; empty if there are none. A stamp of 0 becomes the
          time at which `read` returned. Never make a new message of an old measurement: it would look fresh. The very
          object of before, or an equal one with its stamp, counts as none.
        """
        raise NotImplementedError

    def kept(self) -> tuple[float, ...] | None:
        """Set-points at which axes with `kept` in `driver.toml`, such as a gripper, stay as they are.

        Called after each `read` that has measured something, in its thread. While nobody has armed the robot they are
        written in the place of the last ones; before the first of them nothing is written at all.

        Returns:
          One for each axis, of which only those with `kept` count, e.g. the width that a gripper is set to, so that it
          goes on holding a cup. None: unknown. A class without this method keeps the last set-point, at first `kept`.
        """
        return None

    def write(self, values: tuple[float, ...]) -> None:
        """Send set-points that the guard has passed, while another thread waits in `read`.

        Args:
          values: In the order and the units of the axes in `driver.toml`; zero stops an axis.
        """
        raise NotImplementedError

    def close(self) -> None:
        """Release the device, after the set-points for standstill were written if that was possible.

        Also called after `open` failed, and while a stalled `read` or `write` has not returned: it should end them.
        """
