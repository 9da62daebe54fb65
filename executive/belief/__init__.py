"""State estimation: pure filters from samples to beliefs. They use no clock and no robot's constants."""
