"""Predicts how long the soccer robot needs from one pose to another, for two speeds at the goal."""

import numpy as np

from tailor.models.runtime import load_robot

durations, _ = load_robot("agilo")
names = "x, y, phi, v, xg, yg, phig, vg"  # m, rad, m/s: start and goal in the field's frame
poses = np.array([[0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.5, speed] for speed in (0.0, 0.3)])
means_s, stds_s = durations["goToPose/duration"].predict(poses)
for pose, mean_s, std_s in zip(poses, means_s, stds_s, strict=True):
    print(f"({names}) = {pose}: {mean_s:.2f} s, standard deviation {std_s:.2f} s")
