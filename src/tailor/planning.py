"""The planner as a library: parse PDDL, ground and search in portions, validate and explain plans.

Every public name of `tailor.executive.planning`, and the budget that the searches are advanced with. A name is loaded
at its first use, so the import itself takes no time. `docs/planning.md` has an example.
"""

from typing import TYPE_CHECKING, Any

from tailor.executive import planning
from tailor.executive.interfaces.budget import Budget, CheckBudget

if TYPE_CHECKING:
    from tailor.executive.planning import *  # noqa: F403

__all__ = ["Budget", "CheckBudget"]
__all__ += planning.__all__


def __getattr__(name: str) -> Any:
    """Loads a public name."""
    if name not in planning.__all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = globals()[name] = getattr(planning, name)
    return value


def __dir__() -> list[str]:
    """The public names, for interpreters that complete them."""
    return sorted(__all__)
