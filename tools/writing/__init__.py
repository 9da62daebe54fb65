"""Letters written by the arm: tracks from messages, measures, and writing in lock-step."""
