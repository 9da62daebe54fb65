"""Learners by name, training, testing, calibration."""
