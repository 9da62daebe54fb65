"""The feature spaces that the B21's package declares: spots on tables, its drives, and furniture beside them."""

from __future__ import annotations

from tailor.models.features.drive_clearance.beside_box import beside_box
from tailor.models.features.drive_clearance.driving_robot import Drift, DrivingRobot
from tailor.models.features.kitchen.spots import SPOTS
from tailor.models.features.straight_drive import BACK_M, BACK_RAD, NEAR_M, straight_drive
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M, V_MAX_MPS

B21 = DrivingRobot(
    base_m=BASE_RADIUS_M,
    hand_m=(0.535, 0.40),  # of the folded arm
    hand_radius_m=0.075,
    hand_bottom_m=1.03,
    v_max_mps=V_MAX_MPS,
    bend_worth_radps=0.6,
    near_m=NEAR_M,
    back_m=BACK_M,
    back_rad=BACK_RAD,
    there_m=0.05,
    drift=Drift(0.44, 1.6, 1.2, 1.9),  # fitted to 500 drives; small turns take longer for their size
    braking_mps2=0.59,  # turns by more than a right angle that begin with 0.1 to 0.55 m/s, within 1 cm
)

one_box = beside_box("one-box", B21)
SPACES = (*SPOTS, straight_drive, one_box)
