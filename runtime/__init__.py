"""NERVES: the only place that touches zenoh, the clock and the operating system."""
