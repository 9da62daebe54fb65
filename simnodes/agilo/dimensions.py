"""Sizes and masses of scene.xml, for computations without MuJoCo; a test compares them with the model."""

from __future__ import annotations

WHEEL_RADIUS_M = 0.0625
WHEEL_MASS_KG = 0.5
WHEEL_ARMATURE_KGM2 = 0.002  # motor and gear of a wheel
TRACK_M = 0.30
CHASSIS_MASS_KG = 14.0
CHASSIS_LENGTH_M = 0.41
CHASSIS_WIDTH_M = 0.32
MASS_AHEAD_M = -0.035  # centre of mass, from the axle
RAIL_AHEAD_M = 0.20  # deepest point of the rail's arc, from the axle
BALL_RADIUS_M = 0.11
BALL_IN_RAIL_M = RAIL_AHEAD_M + BALL_RADIUS_M  # centre of a ball that lies in the rail, from the axle
