"""Constants of the PowerCube arm: its writing joints and their limits. Radians, seconds."""

from __future__ import annotations

JOINTS = ("pan", "lift")  # the paper's a and b; positive to the right and upward
V_MAX_RADPS = 1.2
ANGLE_MAX_RAD = 2.0
PEN_M = 0.75  # from the shoulder to the tip of the pen, nearly: what a radian is worth on the page
