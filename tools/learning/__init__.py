"""Gathering of episodes and training of models."""
