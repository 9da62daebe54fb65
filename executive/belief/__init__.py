"""State estimation: pure filters from samples to beliefs. Knows no robot and no clock."""
