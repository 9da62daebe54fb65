"""Bus, clock, real-time loop, processes, recordings: the only package that calls zenoh and the operating system."""
