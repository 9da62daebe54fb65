"""The bodies that evaluations run on: as gathered from, or degraded, which stands in for the real robot."""

from __future__ import annotations

import math
from functools import lru_cache

from executive import domains
from schemas.errors import UsageError
from simnodes.agilo.body import AgiloBody
from simnodes.agilo.physique import Physique
from simnodes.agilo.sensing import Sensing
from simnodes.body import Body
from tools.lockstep import new_body

PROFILES = ("", "degraded")


@lru_cache(maxsize=4)
def body_of(domain: str, profile: str) -> Body:
    """A body for a domain's robot, made once a process; resetting it makes an episode independent of the last.

    Raises:
      UsageError: The domain has no such profile.
    """
    if profile not in PROFILES or (profile and domain != "soccer"):
        raise UsageError(f"no profile '{profile}' of {domain}'s body, expected one of: as gathered, degraded (soccer)")
    if not profile:
        return new_body(domains.load(domain))
    return AgiloBody(_worn_physique(), _poor_sensing())


def _worn_physique() -> Physique:
    """Worn tyres, a heavier load, a duller servo and a carpet of another sort than where experience was gathered."""
    return Physique(wheel_friction=0.8, chassis_mass_kg=15.5, servo_gain=1.0, ball_rolling_m=0.0105, rail_friction=0.14)


def _poor_sensing() -> Sensing:
    """Half as much noise again, one percept in seven lost, a camera that is late by 80 ms."""
    return Sensing(
        pose_sigma_m=0.065,
        pose_sigma_rad=math.radians(3.3),
        pose_dropout=0.15,
        ball_dropout=0.15,
        ball_share=0.075,
        encoder_scale=0.02,
        camera_delay_ns=80_000_000,
    )
