"""The warehouse: gliding between bays, hoisting the forks between levels."""

import math
from dataclasses import dataclass, replace
from importlib import resources

from tailor.executive.interfaces.action import Action, Control, Parameter
from tailor.executive.interfaces.domain import Axis
from tailor.executive.interfaces.values import Interval
from truck.topics import TruckCommand, TruckState

PACE_MPS, PASSING_MPS, LIFT_MPS, BRAKING_MPS2 = 0.9, 0.5, 0.25, 0.6


@dataclass(frozen=True)
class Seen:
    """Where the truck is, m, and how fast, m/s."""

    time_ns: int = 0
    at: tuple[float, ...] = (0.0, 0.0, 0.0)
    rates: tuple[float, ...] = (0.0, 0.0, 0.0)

    @property
    def pace(self):
        return math.hypot(*self.rates[:2])


def glide(state, now_ns, belief, arguments):
    """Straight to the goal, which is passed with the requested pace; braking begins in time."""
    _, _, _, east, north, pace = arguments.tolist()
    dx, dy = east - belief.at[0], north - belief.at[1]
    way = math.hypot(dx, dy)
    speed = min(PACE_MPS, math.sqrt(pace**2 + 2 * BRAKING_MPS2 * way))
    command = (speed * dx / way, speed * dy / way, 0.0) if way > 1e-6 else (0.0, 0.0, 0.0)
    return Control(None, command, "done" if way < 0.05 + 0.05 * speed else "running")


def hoist(state, now_ns, belief, arguments):
    """Straight up or down."""
    off = arguments.tolist()[1] - belief.at[2]
    speed = min(LIFT_MPS, math.sqrt(2 * 0.3 * abs(off)))
    return Control(None, (0.0, 0.0, math.copysign(speed, off)), "done" if abs(off) < 0.02 else "running")


def _bay(suffix, argument):
    return (
        Parameter(f"east{suffix}", argument, "east", "m", -5.0, 5.0),
        Parameter(f"north{suffix}", argument, "north", "m", -5.0, 5.0),
        Parameter(f"pace{suffix}", argument, "pace", "m/s", 0.0, PASSING_MPS),
    )


def _level(suffix, argument):
    return (Parameter(f"height{suffix}", argument, "height", "m", 0.0, 2.0),)


class Warehouse:
    """See tailor.executive.interfaces.domain.Domain."""

    name, robot = "warehouse", "truck-7"
    pddl = resources.files(__package__).joinpath("warehouse.pddl").read_text(encoding="utf-8")
    actions = {
        "GlideTo": Action("GlideTo", (*_bay("", 0), *_bay("_goal", 1)), glide, "GlideTo/duration"),
        "HoistTo": Action("HoistTo", (*_level("", 0), *_level("_goal", 1)), hoist, "HoistTo/duration"),
    }
    executables = {"glide": "GlideTo", "hoist": "HoistTo"}
    axes = (
        Axis("eastward", "m/s", -1.0, 1.0),
        Axis("northward", "m/s", -1.0, 1.0),
        Axis("lifting", "m/s", -0.3, 0.3),
    )
    command_topic = "truck_axes"
    sensors = required = ("truck_tags",)
    belief_names = ("east (m)", "north (m)", "height (m)", "pace (m/s)")

    def initial_belief(self):
        return Seen()

    def update(self, belief, now_ns, samples, command):
        for sample in samples:
            if isinstance(sample.message, TruckState) and len(sample.message.rates) == 3:
                seen = sample.message
                belief = Seen(sample.arrival_ns, (seen.east, seen.north, seen.height), seen.rates)
        if not belief.time_ns:
            return belief
        ahead_s = 1e-9 * (now_ns - belief.time_ns)
        at = tuple(q + ahead_s * rate for q, rate in zip(belief.at, belief.rates, strict=True))
        return replace(belief, time_ns=now_ns, at=at)

    def ready(self, belief):
        return belief.time_ns > 0

    def belief_values(self, belief):
        return (*belief.at, belief.pace)

    def anchor(self, belief, scenario, remembered):
        return remembered

    def value(self, query):
        east, north, height = query.belief.at
        values = {}
        if ("parked", query.label) in query.holds:
            values = {"east": east, "north": north, "pace": min(PASSING_MPS, query.belief.pace)}
        elif ("forks", query.label) in query.holds:
            values = {"height": height}
        elif any(fact[0] in ("lane", "rack") and fact[2] == query.label for fact in query.holds):
            values = query.scenario.places[query.label]
        exact = values.get(query.quantity)
        return None if exact is None else Interval(exact, exact)

    def message(self, command, stamp_ns):
        return TruckCommand(stamp_ns, *command)
