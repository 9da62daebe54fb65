"""Random places and widths, to learn from and to work at."""

from porter.depot import Seen
from tailor.tools.lockstep.task_sampler import TaskSampler


def draw(declared, rng):
    """See DomainSpec.draw."""
    stops = declared["stops"]
    along = [rng.uniform(-3.0, 3.0)]
    while len(along) <= len(stops):
        further = rng.uniform(-3.0, 3.0)
        if abs(further - along[-1]) > 0.8:
            along.append(further)
    places = {stop: {"along": at} for stop, at in zip(stops, along[1:], strict=True)}
    return {"along": along[0]}, {**places, "tight": {"width": rng.uniform(0.01, 0.05)}}, ()


class Tasks(TaskSampler):
    """See tailor.tools.lockstep.task_sampler.TaskSampler."""

    def sample(self, action, rng):
        while True:
            drawn = rng.uniform([p.lower for p in action.parameters], [p.upper for p in action.parameters])
            if action.name == "Squeeze" or abs(drawn[2] - drawn[0]) > 0.5:
                return drawn

    def start(self, action, arguments, rng):
        if action.name == "Squeeze":
            return {"width": arguments[0].item()}
        along, pace, goal, _ = arguments.tolist()
        return {"along": along, "rate": pace if goal > along else -pace}

    def belief(self, start, rng):
        return Seen(0, start.get("along", 0.0), start.get("rate", 0.0), start.get("width", 0.12))

    def arguments_now(self, action, belief, arguments):
        if action.name == "Squeeze":
            return [belief.width, *arguments[1:].tolist()]
        return [belief.along, min(0.5, abs(belief.rate)), *arguments[2:].tolist()]
