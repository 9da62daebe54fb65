"""Clauses that concern what people see: scenes of the belief, of the truth and of subgoals."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import astuple

from tailor.executive.robot_models import PLACE_UNIT
from tailor.schemas.messages import Message
from tailor.schemas.packages.scene import Scene, on_map
from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import Subject

MAX_SHAPES = 200
ASTRAY_M = 1.0  # between belief and truth, after three seconds of looking


@clause("scenario", needs="scene")
def scene_can_be_drawn(subject: Subject, case: str) -> Iterator[str]:
    """Belief and truth are drawn: finite numbers, at most 200 shapes, names that differ, frames that lead to "map"."""
    for source, scene in _scenes(subject, case):
        yield from (f"{source}: {fault}" for fault in _faults(scene, source == "belief"))


def _faults(scene: Scene, robot_expected: bool) -> Iterator[str]:
    names, frames = [shape.name for shape in scene.shapes], on_map(scene.frames)
    twice = sorted({name for name in names if names.count(name) > 1})
    yield from (f"the name '{name}' occurs twice" for name in twice)
    if len(names) > MAX_SHAPES:
        yield f"{len(names)} shapes, expected at most {MAX_SHAPES}"
    for shape in scene.shapes:
        if shape.frame not in frames:
            yield f"'{shape.name}' stands in the frame '{shape.frame}', expected one of: {', '.join(frames)}"
        numbers = [*shape.points, *(value for value in astuple(shape) if isinstance(value, float))]
        if not all(map(math.isfinite, numbers)):
            yield f"'{shape.name}' has a number that is not finite"
    if scene.tracer not in frames and (scene.frames or robot_expected):
        yield f"there is no frame '{scene.tracer}', whose way is drawn"


@clause("scenario", needs="scene")
def belief_is_drawn_where_the_truth_is(subject: Subject, case: str) -> Iterator[str]:
    """After three seconds of looking around, belief and truth are drawn in the same place."""
    scenes = dict(_scenes(subject, case))
    places = [on_map(scene.frames).get(scene.tracer) for scene in scenes.values() if scene.frames]
    drawn = [(each.x, each.y, each.z) for each in places if each is not None]
    if len(drawn) == 2 and (apart_m := math.dist(*drawn)) > ASTRAY_M:
        yield f"the belief is drawn {apart_m:.1f} m from the truth"


@clause("package", needs="scene")
def subgoals_have_places(subject: Subject, case: str) -> Iterator[str]:
    """A subgoal with values for all quantities of an action's last label is drawn somewhere, if one is in metres."""
    view = subject.scene
    for name, action in subject.domain.actions.items():
        last = max((parameter.argument for parameter in action.parameters), default=0)
        goals = [parameter for parameter in action.parameters if parameter.argument == last]
        places = [parameter.quantity for parameter in goals if parameter.unit == PLACE_UNIT]
        if places and view.of_subgoal({p.quantity: (p.lower + p.upper) / 2 for p in goals}) is None:
            wanted = f"expected a pose: {', '.join(places)} are in metres, which mark a place"
            yield f"{name}: of_subgoal returns None for {', '.join(p.quantity for p in goals)}, {wanted}"


def _scenes(subject: Subject, case: str) -> Iterator[tuple[str, Scene]]:
    """The scene of the belief after a look around, and that of the truth."""
    names = [name.partition(" (")[0].replace(" ", "_") for name in subject.domain.belief_names]
    belief = subject.domain.initial_belief()
    truth: Message | None = None
    if subject.spec.body:
        belief, _ = subject.look(subject.scenario(case, 0)[1])
        truth = subject.body.ground_truth()
    values = subject.domain.belief_values(belief)
    if all(map(math.isfinite, values)):  # otherwise another clause is broken
        yield "belief", subject.scene.of_belief(dict(zip(names, values, strict=False)))
    if truth is not None:
        yield "truth", subject.scene.of_truth(truth)
