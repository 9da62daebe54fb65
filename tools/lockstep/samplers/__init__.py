"""Task samplers, one for each robot: random tasks, start states, and the failures that the ground truth shows."""
