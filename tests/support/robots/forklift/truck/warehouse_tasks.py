"""Random bays and levels, to learn from and to work at."""

import math

from tailor.tools.lockstep.task_sampler import TaskSampler
from truck.warehouse import Seen


def draw(declared, rng):
    """See DomainSpec.draw."""
    bays = declared["bays"]
    start = {"east": rng.uniform(-3.0, 3.0), "north": rng.uniform(-3.0, 3.0)}
    places = {bay: {"east": rng.uniform(-3.0, 3.0), "north": rng.uniform(-3.0, 3.0)} for bay in bays}
    if len(bays) > 1:
        places[bays[-1]]["pace"] = 0.0
    return start, {**places, declared["level"]: {"height": rng.uniform(0.3, 1.5)}}, ()


class Tasks(TaskSampler):
    """See tailor.tools.lockstep.task_sampler.TaskSampler."""

    def sample(self, action, rng):
        return rng.uniform([p.lower for p in action.parameters], [p.upper for p in action.parameters])

    def start(self, action, arguments, rng):
        if action.name == "HoistTo":
            return {"height": arguments[0].item()}
        east, north, pace, east_goal, north_goal, _ = arguments.tolist()
        way = math.hypot(east_goal - east, north_goal - north) or 1.0
        rates = {"east_rate": pace * (east_goal - east) / way, "north_rate": pace * (north_goal - north) / way}
        return {"east": east, "north": north, **rates}

    def belief(self, start, rng):
        at = tuple(start.get(name, 0.0) for name in ("east", "north", "height"))
        return Seen(0, at, (start.get("east_rate", 0.0), start.get("north_rate", 0.0), 0.0))

    def arguments_now(self, action, belief, arguments):
        if action.name == "HoistTo":
            return [belief.at[2], arguments[1].item()]
        return [*belief.at[:2], belief.pace, *arguments[3:].tolist()]
