"""What a robot's package declares: whether its parts fit together, before anything starts."""
