"""Finished plans as values: text formats, schedules, work in portions."""
