"""Model cards: contents, shape, checks."""
