"""Constants of the AGILO robot's body: its reach and its limits. Metres, seconds, radians."""

from __future__ import annotations

V_MAX_MPS = 0.9
OMEGA_MAX_RADPS = 1.75
# Without these two, approaches over a metre that turn one way and bend the other passed 0.1 m beside the ball
SHARP_RADPS = 1.4  # where its way asks it to turn faster, the robot slows down
LATE_M = 0.1  # so far into a bend it may still turn towards its way
SPEED_LAG_S = 0.08  # of the speed behind the command: half a tick until the next command, and 0.03 s of the servos
IN_RAIL_M = 0.31  # from the axle to the centre of a ball that lies in the rail
RAIL_TIP_M = (0.288, 0.119)  # of the left tip, ahead of the axle and left of it
BALL_AND_RAIL_M = 0.115  # from the axis of the rail's rod to the centre of a ball that touches it
# Between ball and rail where an approach ends. From 0.03 to 0.09 as few of 800 random approaches (2.0 to 2.6 %) bump
# the ball and they take as long; at 0.03 the tips of the rail would touch a ball that lies 2 cm aside.
CLEARANCE_M = 0.05
BEHIND_BALL_M = IN_RAIL_M + CLEARANCE_M  # from the axle to the ball where an approach ends
BALL_ROLLING_MPS2 = 0.53  # deceleration of the free ball
CRADLE_AHEAD_M = (0.27, 0.355)  # where a ball can be, in the robot's frame, and count as held by the rail
CRADLE_LEFT_M = 0.07
