"""Controllers that drive around what is in their way by hand-made geometry.

They have the same belief, and drive to poses of a `DetourGraph` with the same goToPose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.actions.dubins import Pose2
from tailor.executive.actions.planar import PHI, PHIG, VG, XG, YG, PlanarBelief, X, Y
from tailor.executive.belief.angles import difference
from tailor.executive.interfaces.action import Action, Control, Controller
from tailor.executive.interfaces.action_context import ActionContext
from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.detours.geometry import GEOMETRIES, Geometry, distances, objects_of
from tailor.tools.evaluations.detours.graph import DetourGraph
from tailor.tools.evaluations.detours.legs import Legs, legs_of

TURNING_RADPS = 0.8  # faster than to hold a course
MOVED_M = 0.06  # something believed elsewhere by so much: the way is planned anew
HEADINGS = 24
FREE_HEADINGS = ("to-cupboard",)  # scenarios whose goal leaves the heading open
SEEN = "seen"  # quantity: whether a robot has seen what may stand behind it


@dataclass(frozen=True, slots=True)
class Detour:
    """State of a `DetourController`: poses still to pass, the goal last, what was in the way, state of the leg."""

    poses: tuple[Pose2, ...]
    objects: Array
    leg: Any = None


@dataclass(frozen=True, slots=True)
class DetourController:
    """Drives over poses of a detour graph, then on as the action does by itself.

    Attributes:
      action: Controller of the action.
      go: Drives to the poses.
      legs: Its ways while the robot has not seen what may stand behind it, and when it has.
      geometry: The robot.
      context: Yields what is in the way.
      field: Half the length and half the width of where poses may lie, m.
      seen: Number of the argument that says so, if there is one.
      free_heading: Whether any heading at the goal will do.
    """

    action: Controller
    go: Controller
    legs: tuple[Legs, Legs]
    geometry: Geometry
    context: ActionContext
    field: tuple[float, float]
    seen: int | None = None
    free_heading: bool = False

    def __call__(self, state: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller."""
        objects = objects_of(self.context, belief)
        if not isinstance(state, Detour) or _moved(state.objects, objects):
            state = self._planned(state, belief, arguments, objects)
        last = len(state.poses) == 1
        speed_mps = float(arguments[VG]) if last else self.geometry.passing_mps
        drive = self.action if last else self.go
        control = drive(state.leg, now_ns, belief, _leg(arguments, belief, state.poses[0], speed_mps))
        if control.outcome == "running" or last:
            return self._turning_first(replace(control, state=replace(state, leg=control.state)), belief)
        return replace(control, state=Detour(state.poses[1:], state.objects), outcome="running")

    def _turning_first(self, control: Control, belief: PlanarBelief) -> Control:
        """Beside something the robot turns on the spot to its way; goToPose would drive on as it turns."""
        leg = control.state.leg
        begun = getattr(leg, "inner", leg) is not None  # of goToPose within another controller, or of its own
        if abs(control.command[1]) < TURNING_RADPS or begun or control.outcome != "running":
            return control
        near = _is_near(belief, control.state.objects, self.geometry.turn_first_m)
        return replace(control, command=(0.0, control.command[1])) if near else control

    def _planned(self, state: Any, belief: PlanarBelief, arguments: Array, objects: Array) -> Detour:
        """A new way; one that still stays clear is kept."""
        legs = self.legs[self.seen is not None and bool(arguments[self.seen])]
        margins = self.geometry.margins_m
        graphs = [DetourGraph(legs, self.geometry, objects, self.field, margin_m) for margin_m in margins]
        here, goal_mps = (belief.pose.x, belief.pose.y, belief.pose.phi), float(arguments[VG])
        if isinstance(state, Detour) and graphs[0].is_clear((here, *state.poses), goal_mps):
            return replace(state, objects=objects)
        goals = self._goals(arguments)
        ways = (graph.quickest(here, goals, goal_mps) for graph in graphs)
        return Detour(next((way for way in ways if way is not None), goals[:1]), objects)

    def _goals(self, arguments: Array) -> tuple[Pose2, ...]:
        """The goal, and with other headings if these will do."""
        x, y, phi = arguments[[XG, YG, PHIG]].tolist()
        turns = range(HEADINGS if self.free_heading else 1)
        return tuple((x, y, difference(phi + math.tau * turn / HEADINGS, 0.0)) for turn in turns)


def with_detours(domain: Any, name: str, scenario: str) -> Any:
    """A domain whose controllers drive around the objects of their actions' contexts: no model predicts these then."""
    geometry, free_heading = GEOMETRIES[name], scenario in FREE_HEADINGS
    actions = {key: _detouring(domain, action, geometry, free_heading) for key, action in domain.actions.items()}
    return replace(domain, actions=actions)


def _detouring(domain: Any, action: Action, geometry: Geometry, free_heading: bool) -> Action:
    if action.context is None:
        return action
    go = domain.actions[action.subgoal_action].controller
    x, y = (next(p for p in action.parameters if p.quantity == name) for name in ("x", "y"))
    seen = next((k for k, each in enumerate(action.parameters) if each.quantity == SEEN), None)
    field = x.upper, y.upper
    legs = legs_of(go, seen=False), legs_of(go, seen=True)
    controller = DetourController(action.controller, go, legs, geometry, action.context, field, seen, free_heading)
    return replace(action, controller=controller, context=None)


def _is_near(belief: PlanarBelief, objects: Array, near_m: float) -> bool:
    place = np.array([[belief.pose.x, belief.pose.y]])
    return len(objects) > 0 and float(distances(place, objects).min()) < near_m


def _leg(arguments: Array, belief: PlanarBelief, goal: Pose2, goal_mps: float) -> Array:
    """Arguments of a leg that begins here: controllers may look at the start, too."""
    leg = np.array(arguments)
    leg[[X, Y, PHI]] = belief.pose.x, belief.pose.y, belief.pose.phi
    leg[[XG, YG, PHIG, VG]] = (*goal, goal_mps)
    return leg


def _moved(before: Array, now: Array) -> bool:
    """Whether the objects differ in number, or one of them by more than MOVED_M."""
    if len(before) != len(now):
        return True
    return any(float(np.hypot(*(before[:, :2] - each).T).min()) > MOVED_M for each in now[:, :2])
