"""Baseline of subgoal assertion: controllers that drive around what is in their way by hand-made geometry.

They have the same belief, and drive to poses of a `DetourGraph` with the same goToPose.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.dubins import Pose2
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.actions.planar import PHI, PHIG, VG, XG, YG, PlanarBelief, X, Y
from tailor.executive.interfaces.action import Action, Control, Controller
from tailor.executive.interfaces.action_context import ActionContext
from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.detour_graph import CLEARANCES_M, PASSING_MPS, DetourGraph, Disc

NEAR_M = 0.6  # from a disc's edge
TURNING_RADPS = 0.8  # faster than to hold a course
MOVED_M = 0.06  # a disc believed elsewhere by so much: the way is planned anew


@dataclass(frozen=True, slots=True)
class Detour:
    """State of a `DetourController`: poses still to pass, what was in the way then, state of the leg's controller."""

    poses: tuple[Pose2, ...]
    discs: tuple[Disc, ...]
    leg: Any = None


@dataclass(frozen=True, slots=True)
class DetourController:
    """Drives over poses of a detour graph, then on as the action does by itself.

    Attributes:
      action: Controller of the action.
      go: Drives to the poses.
      ways: Paths that it drives.
      context: Yields what is in the way; of this, discs count.
      field: Half the length and half the width of where poses may lie, m.
    """

    action: Controller
    go: Controller
    ways: ArrivalPath
    context: ActionContext
    field: tuple[float, float]

    def __call__(self, state: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller."""
        discs = discs_of(self.context, belief)
        if not isinstance(state, Detour) or _moved(state.discs, discs):
            state = self._planned(state, belief, arguments, discs)
        if state.poses:
            control = self.go(state.leg, now_ns, belief, _to(arguments, state.poses[0], belief))
            if control.outcome == "running":
                return _turning_first(replace(control, state=replace(state, leg=control.state)), belief)
            state = Detour(state.poses[1:], state.discs)
            return replace(control, state=state, outcome="running")
        control = self.action(state.leg, now_ns, belief, _from(arguments, belief))
        return _turning_first(replace(control, state=replace(state, leg=control.state)), belief)

    def _planned(self, state: Any, belief: PlanarBelief, arguments: Array, discs: tuple[Disc, ...]) -> Detour:
        """A new way; one that still stays clear is kept."""
        graphs = [DetourGraph(self.ways, discs, self.field, clear_m) for clear_m in CLEARANCES_M]
        here = (belief.pose.x, belief.pose.y, belief.pose.phi)
        goal = (float(arguments[XG]), float(arguments[YG]), float(arguments[PHIG]))
        goal_mps = float(arguments[VG])
        if isinstance(state, Detour) and _stays_clear(graphs[0], here, state.poses, goal, goal_mps):
            return replace(state, discs=discs)
        ways = (graph.shortest(here, goal, goal_mps) for graph in graphs)
        return Detour(next((way for way in ways if way is not None), ()), discs)


def discs_of(context: ActionContext, belief: PlanarBelief) -> tuple[Disc, ...]:
    """The cylinders among the objects: x, y and radius are the columns that end so; one with other sizes is a box."""
    suffix = [name.rpartition("_")[2] for name in context.names]
    x, y, r = (suffix.index(each) for each in ("x", "y", "r"))
    sizes = [k for k, each in enumerate(suffix) if each in ("long", "wide")]
    rows = context.believed(belief)
    return tuple((row[x], row[y], row[r]) for row in rows if not any(row[k] for k in sizes))


def with_detours(domain: Any) -> Any:
    """A domain whose controllers drive around the objects of their actions' contexts: no model predicts these then."""
    return replace(domain, actions={name: _detouring(domain, action) for name, action in domain.actions.items()})


def _detouring(domain: Any, action: Action) -> Action:
    if action.context is None:
        return action
    go = domain.actions[action.subgoal_action].controller
    x, y = (next(p for p in action.parameters if p.quantity == name) for name in ("x", "y"))
    controller = DetourController(action.controller, go, _ways(go), action.context, (x.upper, y.upper))
    return replace(action, controller=controller, context=None)


def _ways(go: Any) -> ArrivalPath:
    """Paths of a goToPose, or of the one that drives a controller's far ways."""
    ways: ArrivalPath = go.ways if isinstance(go, GoToPose) else go.far.ways
    return ways


def _turning_first(control: Control, belief: PlanarBelief) -> Control:
    """Beside a disc the robot turns on the spot to its way; goToPose would drive on as it turns."""
    state = control.state
    if abs(control.command[1]) < TURNING_RADPS or state.leg is not None or control.outcome != "running":
        return control
    near = any(np.hypot(belief.pose.x - x, belief.pose.y - y) < radius + NEAR_M for x, y, radius in state.discs)
    return replace(control, command=(0.0, control.command[1])) if near else control


def _stays_clear(graph: DetourGraph, here: Pose2, poses: Sequence[Pose2], goal: Pose2, goal_mps: float) -> bool:
    stops = [here, *poses, goal]
    speeds = [PASSING_MPS] * len(poses) + [goal_mps]
    return all(graph.clear(a, b, v) for a, b, v in zip(stops, stops[1:], speeds, strict=False))


def _from(arguments: Array, belief: PlanarBelief) -> Array:
    """Arguments of a leg that begins here: controllers may look at the start, too."""
    begun = np.array(arguments)
    begun[[X, Y, PHI]] = belief.pose.x, belief.pose.y, belief.pose.phi
    return begun


def _to(arguments: Array, pose: Pose2, belief: PlanarBelief) -> Array:
    to = _from(arguments, belief)
    to[[XG, YG, PHIG, VG]] = (*pose, PASSING_MPS)
    return to


def _moved(before: Sequence[Disc], now: Sequence[Disc]) -> bool:
    """Whether the discs differ in number, or one of them by more than MOVED_M."""
    if len(before) != len(now):
        return True
    return any(min(np.hypot(a[0] - b[0], a[1] - b[1]) for b in before) > MOVED_M for a in now)
