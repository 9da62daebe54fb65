"""Bounds on what becomes of partial plans: their least makespan, by the use of exclusive facts."""
