"""Text to expressions: parentheses and words, their places, errors at a place. Knows no language."""
