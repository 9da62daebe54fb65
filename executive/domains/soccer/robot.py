"""Constants of the AGILO robot's body: its reach and its limits. Metres, seconds, radians."""

from __future__ import annotations

V_MAX_MPS = 0.9
OMEGA_MAX_RADPS = 1.75
IN_RAIL_M = 0.31  # from the axle to the centre of a ball that lies in the rail
CLEARANCE_M = 0.05  # between ball and rail where an approach ends: half of the random approaches then collide
BEHIND_BALL_M = IN_RAIL_M + CLEARANCE_M  # from the axle to the ball where an approach ends
BALL_ROLLING_MPS2 = 0.53  # deceleration of the free ball
CRADLE_AHEAD_M = (0.27, 0.355)  # where a ball can be, in the robot's frame, and count as held by the rail
CRADLE_LEFT_M = 0.07
