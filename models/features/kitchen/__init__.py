"""Feature spaces of the B21 in its kitchen."""
