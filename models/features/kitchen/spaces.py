"""The feature spaces that the B21's package declares: spots on tables, and furniture beside its drives."""

from __future__ import annotations

from tailor.models.features.drive_clearance.beside_box import beside_box
from tailor.models.features.drive_clearance.driving_robot import Drift, DrivingRobot
from tailor.models.features.kitchen.spots import SPOTS
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M, V_MAX_MPS

B21 = DrivingRobot(
    base_m=BASE_RADIUS_M,
    hand_m=(0.535, 0.40),  # of the folded arm
    hand_radius_m=0.075,
    hand_bottom_m=1.03,
    v_max_mps=V_MAX_MPS,
    bend_worth_radps=0.6,
    near_m=1.0,
    there_m=0.05,
    drift=Drift(0.42, 0.65, 0.45, 2.7),  # fitted to 1500 drives; small turns take longer for their size
    braking_mps2=0.59,  # turns by more than a right angle that begin with 0.1 to 0.55 m/s, within 1 cm
)

one_box = beside_box("one-box", B21)
SPACES = (*SPOTS, one_box)
