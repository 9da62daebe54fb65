"""Profiles of the AGILO robot: nominal, and degraded compared with the robot that its models were learned on.

The degraded profile stands in for the real robot: worse camera, later and fewer percepts, other tyres and floor.
"""

from __future__ import annotations

import math

from tailor.simnodes.agilo.body import AgiloBody
from tailor.simnodes.agilo.physical_parameters import PhysicalParameters
from tailor.simnodes.agilo.sensing import Sensing

PROFILES = {
    "nominal": (PhysicalParameters(), Sensing()),
    "degraded": (
        PhysicalParameters(wheel_friction=0.7, servo_gain=0.8, rail_friction=0.13, ball_rolling_m=0.0092),
        Sensing(
            pose_sigma_m=0.06,
            pose_sigma_rad=math.radians(3),
            pose_dropout=0.15,
            ball_dropout=0.15,
            odom_scale=0.03,
            camera_delay_ns=80_000_000,
        ),
    ),
}


def body(profile: str = "nominal") -> AgiloBody:
    """A body of a profile.

    Raises:
      KeyError: There is no profile of that name.
    """
    return AgiloBody(*PROFILES[profile])
