"""A driver for a robot with a motor board of its own: `tailor driver examples/rover_driver.py:Rover`."""

import math
import time

from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.simnodes.hardware.interface import Hardware


class Board:
    """Stands for the motor board's library: it ramps speeds, and counts how far the robot has come."""

    def __init__(self, port: str) -> None:
        self.port, self.pose, self.speeds, self.wanted = port, (0.0, 0.0, 0.0), (0.0, 0.0), (0.0, 0.0)

    def move(self, dt: float) -> None:
        """What happens in the real world meanwhile."""
        limits = (0.6 * dt, 1.75 * dt)  # m/s and rad/s
        self.speeds = v, omega = (
            self.speeds[0] + max(-limits[0], min(limits[0], self.wanted[0] - self.speeds[0])),
            self.speeds[1] + max(-limits[1], min(limits[1], self.wanted[1] - self.speeds[1])),
        )
        x, y, phi = self.pose
        self.pose = (x + v * dt * math.cos(phi), y + v * dt * math.sin(phi), phi + omega * dt)


class Rover(Hardware):
    """AGILO's tasks on another base, which knows its place from odometry alone."""

    robot = "agilo"  # its package's driver.toml declares commands, limits and sensors

    def open(self) -> None:
        """Find the board."""
        self.board, self.count = Board("/dev/ttyUSB0"), 0

    def read(self) -> dict[str, Odometry | PoseEstimate]:
        """Odometry 50 times a second; the pose at every fourth."""
        time.sleep(0.02)
        self.board.move(0.02)
        self.count += 1
        x, y, phi = self.board.pose
        phi = math.remainder(phi, math.tau)
        odometry = Odometry(0, x, y, phi, *self.board.speeds)
        if self.count % 4:
            return {"odom": odometry}
        return {"odom": odometry, "pose": PoseEstimate(0, x, y, phi, 1e-4, 1e-4, 1e-4)}

    def write(self, values: tuple[float, ...]) -> None:
        """Forward speed in m/s and turn rate in rad/s, both checked by the guard."""
        self.board.wanted = (values[0], values[1])

    def close(self) -> None:
        """Release the board; the driver has written zero before."""
        self.board.wanted = (0.0, 0.0)
