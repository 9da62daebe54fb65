"""Learned models in words: rules of trees, and which of them applied."""
