"""Poses in 3D: a position and a unit quaternion, composed along a chain of frames."""

from __future__ import annotations

import math
from dataclasses import dataclass

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Pose3:
    """A pose in some frame; metres, and a unit quaternion."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    qw: float = 1.0

    @property
    def yaw(self) -> float:
        """Angle of the own x axis about the frame's z axis, rad."""
        return math.atan2(2 * (self.qw * self.qz + self.qx * self.qy), 1 - 2 * (self.qy**2 + self.qz**2))

    def moved(self, point: Vector) -> Vector:
        """A point that is given relative to this pose, in the frame of the pose."""
        x, y, z = point
        tx, ty, tz = (
            2 * (self.qy * z - self.qz * y),
            2 * (self.qz * x - self.qx * z),
            2 * (self.qx * y - self.qy * x),
        )
        return (
            self.x + x + self.qw * tx + self.qy * tz - self.qz * ty,
            self.y + y + self.qw * ty + self.qz * tx - self.qx * tz,
            self.z + z + self.qw * tz + self.qx * ty - self.qy * tx,
        )

    def then(self, inner: Pose3) -> Pose3:
        """A pose that is given relative to this one, in the frame of this one."""
        (x, y, z), (ax, ay, az, aw) = self.moved((inner.x, inner.y, inner.z)), (self.qx, self.qy, self.qz, self.qw)
        bx, by, bz, bw = inner.qx, inner.qy, inner.qz, inner.qw
        return Pose3(
            x,
            y,
            z,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        )

    def inverse(self) -> Pose3:
        """The frame's pose relative to this pose."""
        back = Pose3(0.0, 0.0, 0.0, -self.qx, -self.qy, -self.qz, self.qw)
        return back.then(Pose3(-self.x, -self.y, -self.z))


def on_plane(x: float, y: float, phi: float = 0.0, z: float = 0.0) -> Pose3:
    """Pose of an upright thing: metres, and its heading in rad."""
    return Pose3(x, y, z, 0.0, 0.0, math.sin(phi / 2), math.cos(phi / 2))


def turned(axis: Vector, angle: float, at: Vector = (0.0, 0.0, 0.0)) -> Pose3:
    """Pose of a joint: turned by an angle (rad) about a unit axis, at a place in m."""
    s = math.sin(angle / 2)
    return Pose3(*at, axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2))
