"""Measures of a piece of writing: distance to its waypoints, and smoothness."""

from __future__ import annotations

import numpy as np

from tailor.executive.domains.arm.robot import PEN_M
from tailor.executive.interfaces.values import Array
from tailor.tools.writing.writing_track import WritingTrack

GRID_S = 0.02  # of the joint states
SMOOTHING = 5  # of them: set-points come every 0.1 s, and their corners are not the arm's


def waypoint_errors_rad(track: WritingTrack) -> Array:
    """Distance of the arm to each waypoint at its time of passing, radians, shape (w,)."""
    count = min(len(track.waypoints), len(track.arrivals_s))
    at = [np.interp(track.arrivals_s[:count], track.times_s, track.angles[:, joint]) for joint in (0, 1)]
    errors: Array = np.linalg.norm(np.stack(at, axis=1) - track.waypoints[:count], axis=1)
    return errors


def rms_jerk(track: WritingTrack) -> float:
    """Root of the mean squared jerk of both joints together, rad/s³, from velocities averaged over 0.1 s."""
    return float(np.sqrt((_jerk(track) ** 2).sum(axis=1).mean()))


def roughness(track: WritingTrack) -> float:
    """Logarithm of the dimensionless jerk: ln(T³ / v_max² · ∫|jerk|² dt), no unit; less is smoother at any speed."""
    square = float((_jerk(track) ** 2).sum() * GRID_S)
    fastest = float(np.linalg.norm(track.velocities, axis=1).max())
    return float(np.log(track.duration_s**3 / fastest**2 * square))


def _jerk(track: WritingTrack) -> Array:
    """rad/s³, shape (n, 2), every GRID_S."""
    times = np.arange(0.0, track.duration_s, GRID_S)
    joints = []
    for joint in (0, 1):
        even = np.interp(times, track.times_s, track.velocities[:, joint])
        smooth = np.convolve(even, np.ones(SMOOTHING) / SMOOTHING, mode="valid")
        joints.append(np.diff(smooth, n=2) / GRID_S**2)
    return np.stack(joints, axis=1)


def pen_m(angles: Array) -> Array:
    """Where the pen is on the page, shape (n, 2) in metres: right and up, seen from behind the arm.

    The page is a sphere about the shoulder, unrolled along its parallels; the pen's small offset is left out.
    """
    pan, lift = angles.T
    return PEN_M * np.stack((pan * np.cos(lift), lift), axis=1)
