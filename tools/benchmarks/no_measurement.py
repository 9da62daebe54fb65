"""Failure of a benchmark: it has measured nothing."""

from __future__ import annotations


class NoMeasurement(Exception):
    """A benchmark, or a part of it, has measured nothing; the message is the reason. `tailor bench` exits with 1."""
