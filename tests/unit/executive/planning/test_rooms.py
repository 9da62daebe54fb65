"""The validator shares no code with the search. (The order of all rooms: tests/unit/house/rooms.toml.)"""

import pytest

from tailor.executive import planning
from tailor.executive.planning.structures.orderings import GOAL_STEP
from tests.unit.house.arrows import MODULES, imported_modules

PLANNING = "executive/planning/"
FINISHED_PLANS = sorted(path for path in MODULES if path.startswith(f"{PLANNING}plans/"))


def reachable(path):
    """The planner's own modules that a module imports, directly or by way of others."""
    reached, pending = set(), [path]
    while pending:
        more = {other for other in imported_modules(pending.pop()) if other.startswith(PLANNING)} - reached
        reached |= more
        pending += more
    return reached


@pytest.mark.parametrize("path", FINISHED_PLANS)
def test_the_validator_and_its_room_share_nothing_with_the_search(path):
    assert {other.removeprefix(PLANNING).split("/")[0] for other in reachable(path)} <= {"plans", "pddl"}


def test_the_search_and_the_finished_plan_number_the_goal_alike():
    assert planning.GOAL == GOAL_STEP
