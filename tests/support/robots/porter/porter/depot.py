"""The depot: rolling along the rail with the base, squeezing with the gripper."""

import math
from dataclasses import dataclass, replace
from importlib import resources

from porter.messages import GripCommand, PorterState, RailCommand
from tailor.executive.interfaces.action import Action, Control, Parameter
from tailor.executive.interfaces.domain import Axis
from tailor.executive.interfaces.outlet import Outlet
from tailor.executive.interfaces.values import Interval

PACE_MPS, PASSING_MPS, BRAKING_MPS2, WIDEST_M, HELD_M = 0.9, 0.5, 0.6, 0.12, 0.004


@dataclass(frozen=True)
class Seen:
    """Place on the rail, m, speed, m/s, and width of the gripper, m."""

    time_ns: int = 0
    along: float = 0.0
    rate: float = 0.0
    width: float = WIDEST_M


def roll(state, now_ns, belief, arguments):
    """To the goal, which is passed with the requested pace."""
    _, _, goal, pace = arguments.tolist()
    off = goal - belief.along
    speed = min(PACE_MPS, math.sqrt(pace**2 + 2 * BRAKING_MPS2 * abs(off)))
    done = abs(off) < 0.04 + 0.05 * speed
    return Control(None, (math.copysign(speed, off),), "done" if done else "running")


def squeeze(state, now_ns, belief, arguments):
    """To the requested width; the margin is the same in every task."""
    _, goal, margin = arguments.tolist()
    return Control(None, (goal,), "done" if abs(goal - belief.width) < margin else "running")


def _place(suffix, argument):
    return (
        Parameter(f"along{suffix}", argument, "along", "m", -4.0, 4.0),
        Parameter(f"pace{suffix}", argument, "pace", "m/s", 0.0, PASSING_MPS),
    )


def _width(suffix, argument):
    return Parameter(f"width{suffix}", argument, "width", "m", 0.0, WIDEST_M)


MARGIN = Parameter("margin_goal", 1, "margin", "m", HELD_M, HELD_M)  # fixed: a range of one point
RAIL, GRIP = (Axis("along", "m/s", -1.0, 1.0),), (Axis("width", "m", 0.0, WIDEST_M, kept=WIDEST_M),)


class Depot:
    """See tailor.executive.interfaces.domain.Domain."""

    name, robot = "depot", "porter-3"
    pddl = resources.files(__package__).joinpath("depot.pddl").read_text(encoding="utf-8")
    actions = {
        "Roll": Action("Roll", (*_place("", 0), *_place("_goal", 1)), roll, "Roll/duration", drives=("base",)),
        "Squeeze": Action(
            "Squeeze", (_width("", 0), _width("_goal", 1), MARGIN), squeeze, "Squeeze/duration", drives=("gripper",)
        ),
    }
    executables = {"roll": "Roll", "squeeze": "Squeeze"}
    axes = (*RAIL, *GRIP)
    outlets = (
        Outlet("base", "porter_rail", RAIL, lambda command, stamp_ns: RailCommand(stamp_ns, *command)),
        Outlet("gripper", "porter_grip", GRIP, lambda command, stamp_ns: GripCommand(stamp_ns, *command)),
    )
    command_topic = "porter_rail"
    sensors = required = ("porter_state",)
    belief_names = ("along (m)", "rate (m/s)", "width (m)")

    def initial_belief(self):
        return Seen()

    def update(self, belief, now_ns, samples, command):
        for sample in samples:
            if isinstance(sample.message, PorterState):
                seen = sample.message
                belief = Seen(sample.arrival_ns, seen.along, seen.rate, seen.width)
        if not belief.time_ns:
            return belief
        return replace(belief, time_ns=now_ns, along=belief.along + 1e-9 * (now_ns - belief.time_ns) * belief.rate)

    def ready(self, belief):
        return belief.time_ns > 0

    def belief_values(self, belief):
        return belief.along, belief.rate, belief.width

    def anchor(self, belief, scenario, remembered):
        return remembered

    def value(self, query):
        belief, values = query.belief, {}
        if ("at", query.label) in query.holds:
            values = {"along": belief.along, "pace": min(PASSING_MPS, abs(belief.rate))}
        elif ("open", query.label) in query.holds:
            values = {"width": max(0.0, min(WIDEST_M, belief.width))}
        elif any(fact[0] in ("next", "tighter") and fact[2] == query.label for fact in query.holds):
            values = query.scenario.places[query.label]
        exact = values.get(query.quantity)
        return None if exact is None else Interval(exact, exact)

    def message(self, command, stamp_ns):
        return RailCommand(stamp_ns, *command)
