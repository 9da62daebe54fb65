"""Lock-step simulation: executive and simulated body in one process, faster than real time."""
