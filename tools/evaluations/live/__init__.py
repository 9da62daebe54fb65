"""Evaluation of live runs: agreement with lock-step."""
