"""Tailor's planner and validators as an engine of unified-planning (extra `up`).

from tailor.tools.up_engine import register

register()  # OneshotPlanner, AnytimePlanner and PlanValidator then know the engine "tailor"
"""

from __future__ import annotations

from typing import Any

NAME = "tailor"


def register(environment: Any = None) -> None:
    """Makes the engine "tailor" known to unified-planning.

    Args:
      environment: Of unified-planning, whose factory receives the engine; None: the global one.

    Raises:
      ModuleNotFoundError: The package unified-planning is not installed: pip install 'tailor[up]'.
    """
    from unified_planning.environment import get_environment

    get_environment(environment).factory.add_engine(NAME, f"{__name__}.engine", "TailorEngine")
