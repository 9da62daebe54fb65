"""Nothing grows with time in the executive's core and in the driver."""

import gc
import sys

import pytest

from tailor.executive.core.state import initial_state
from tailor.executive.core.step import step
from tailor.executive.interfaces.budget import CheckBudget
from tailor.runtime.gc_freeze import gc_frozen
from tailor.schemas.messages import ArmRequest, Sample, VelocityCommand
from tailor.simnodes.driver import Driver
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit
from tests.support.toy_domain import SENDER, inputs, line_context

TICK = 100_000_000
GOAL_TICKS = 50
SPEC = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


def goals_pursued(count):
    """Executive and driver on their way; yields the state after each goal, and the set-points until then."""
    context, driver = line_context(), Driver(SPEC, 7)
    driver.take([Sample("agilo/arm_request", ArmRequest(True, False, SENDER, 0), 0, 1, "f" * 32)], {}, 0)
    state, x, moved_ticks = initial_state(context), 0.0, 0
    for n in range(1, count * GOAL_TICKS + 1):
        now_ns, goal = n * TICK, ""
        if n % GOAL_TICKS == 1:
            goal = "(at a)" if n // GOAL_TICKS % 2 else "(at b)"
        state, outputs = step(context, state, now_ns, inputs(now_ns, x, goal), CheckBudget(100))
        sent = [o.message for o in outputs if isinstance(o.message, VelocityCommand)]
        driver.take([Sample("agilo/cmd_vel", message, now_ns, n, SENDER) for message in sent], {}, now_ns)
        v = driver.guard.output(now_ns)[0]
        x, moved_ticks = x + 0.1 * v, moved_ticks + (v != 0.0)
        driver.state(now_ns, now_ns)
        if n % GOAL_TICKS == 0:
            yield state, moved_ticks


@pytest.mark.promise("P27")
def test_an_executive_and_a_driver_need_no_more_memory_after_sixty_goals_than_after_twenty(measured):
    """1 MB in an hour, which is what a soak tolerates, would be 900 blocks of 60 bytes in these 200 s of robot time."""
    blocks = []
    with gc_frozen():  # a whole suite has loaded millions of objects: each collection would visit them all
        for state, moved_ticks in goals_pursued(60):
            assert moved_ticks > 0
            assert state.task.result == "achieved"
            gc.collect()
            blocks.append(sys.getallocatedblocks())  # those that Python keeps for reuse are counted, and fill up slowly
    measured.add(blocks[-1] - blocks[19], 600, unit="blocks", what="growth in 40 goals")
