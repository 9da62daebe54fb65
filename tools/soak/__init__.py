"""Hours of random faults on whole systems: schedule, faults, invariants, memory."""
