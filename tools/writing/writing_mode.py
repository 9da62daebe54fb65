"""Modes in which the arm writes."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.executive.refinement.objective.settings import RefinementSettings


@dataclass(frozen=True, slots=True)
class WritingMode:
    """A mode of writing: with or without a stop at every waypoint, and settings of refinement."""

    name: str
    refinement: RefinementSettings
    stops: bool = False
