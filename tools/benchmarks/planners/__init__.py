"""What plans cost and are worth: by configuration, over time, within a tick."""
