"""Execution of long plans in lock-step: what a tick takes."""
