"""Profiles of the B21: `paper`, whose robot knows itself exactly (Table 5), and `real`, with noise on every sensor."""

from __future__ import annotations

import math

from tailor.simnodes.b21.body import B21Body
from tailor.simnodes.b21.sensing import Sensing

PROFILES = {
    "paper": Sensing(),
    "real": Sensing(
        pose_sigma_m=0.015,
        pose_sigma_rad=math.radians(1.0),
        pose_dropout=0.03,
        odom_scale=0.01,
        odom_v_mps=0.005,
        odom_omega_radps=0.01,
        joint_offset_rad=0.002,
        joint_sigma_rad=0.0005,
        joint_rate_sigma_radps=0.01,
        width_sigma_m=0.0005,
        force_sigma_n=1.0,
        object_base_m=0.004,
        object_share=0.004,
        object_rad=0.05,
        object_dropout=0.15,
    ),
}


def body(profile: str = "paper") -> B21Body:
    """A body of a profile.

    Raises:
      KeyError: There is no profile of that name.
      ModuleNotFoundError: PyBullet is not installed.
    """
    return B21Body(sensing=PROFILES[profile])
