"""Learners by name, training, testing, calibration; the refinement gate."""
