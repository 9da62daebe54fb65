"""Ceilings of an improvement: choices that are simulated instead of predicted."""
