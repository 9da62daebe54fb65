"""Executive and simulated body joined in one process, as fast as the CPU allows."""
