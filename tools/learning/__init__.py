"""Gathering of episodes and the inputs of training."""
