"""Commands that gather episodes and train models."""
