"""Converts one message into the fields that the page draws: JSON values, rounded, in the units of the message.

`timeline.py` selects the messages and limits their rate.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any, cast

from tailor.schemas import messages as m
from tailor.schemas.reason_text import reason_text
from tailor.tools.scenes.flat import FlatScene, Outline

Fields = dict[str, Any]  # JSON values only

DIGITS = 4  # a tenth of a millimetre
MS = 1e-6  # milliseconds in a nanosecond


def number(value: float) -> float | None:
    """The value rounded; None, JSON's null, if it is not finite."""
    return round(float(value), DIGITS) if math.isfinite(value) else None


def scene(scene: FlatScene) -> Fields:
    """Place of the robot, and of the shapes around it; `phi` is None where it has no heading."""
    phi = None if scene.phi is None else number(scene.phi)
    pose = {"x": number(scene.x), "y": number(scene.y), "phi": phi, "v": number(scene.speed_mps)}
    places = {name: [number(value) for value in place] for name, place in scene.places.items()}
    return pose | ({"places": places} if places else {})


def outline(outline: Outline) -> Fields:
    """Outline of a shape in its own plane."""
    red, green, blue, alpha = outline.colour
    colour = f"rgb({round(255 * red)} {round(255 * green)} {round(255 * blue)} / {round(100 * alpha)}%)"
    return {
        "points": [[number(x), number(y)] for x, y in outline.points],
        "closed": outline.closed,
        "colour": colour,
        "width": number(outline.width_m),
        "words": outline.words,
        "onRobot": outline.on_robot,
        "robots": outline.robots,
    }


def place(point: tuple[float, float]) -> list[float | None]:
    """Place of a subgoal on the page."""
    return [number(point[0]), number(point[1])]


def action(message: m.InstantiatedAction) -> Fields:
    """An action with its parameters: `place` is a parameter's label, `quantity` its name without the goal's g."""
    return {
        "action": message.action,
        "step": message.step,
        "asserted": message.asserted,
        "predicted": number(message.predicted_s),
        "spread": number(message.spread_s),
        "parameters": [_parameter(p) for p in message.parameters],
    }


def subgoals(message: m.Subgoals) -> Fields:
    """The sequence of actions in execution."""
    actions = [action(a) for a in message.actions]
    return {"tick": message.tick, "horizon": message.horizon, "actions": actions}


def refinement(message: m.RefinementReport) -> Fields:
    """The search that chose the subgoals, with the best objective over the evaluations."""
    trace = zip(message.trace_evaluations, message.trace_best_s, strict=False)
    return {
        "tick": message.tick,
        "horizon": message.horizon,
        "solver": message.solver,
        "finished": message.finished,
        "evaluations": message.evaluations,
        "checks": message.checks,
        "greedy": _cost(message.greedy_s),
        "best": _cost(message.best_s),
        "gap": number(message.gap_pct) if message.gap_pct >= 0 else None,
        "trace": [[evaluations, number(best_s)] for evaluations, best_s in trace],
    }


def belief(message: m.ExecStatus) -> Fields:
    """Values of the belief, and how long the action runs."""
    return {
        "elapsed": number(message.action_elapsed_s),
        "predicted": number(message.action_predicted_s),
        "values": [number(value) for value in message.belief],
    }


def finished(message: m.ActionFinished) -> Fields:
    """Outcome of an action."""
    return {
        "action": message.action,
        "index": message.action_index,
        "outcome": message.outcome,
        "reason": reason_text(message.reason, message.detail),
        "predicted": number(message.predicted_s),
        "actual": number(message.actual_s),
    }


def tick(message: m.TickReport) -> Fields:
    """Timing of a tick in milliseconds, and the checks granted to its deliberation."""
    return {
        "tick": message.tick,
        "late": number(message.lateness_ns * MS),
        "control": number(message.control_ns * MS),
        "work": number(message.work_ns * MS),
        "skipped": message.skipped,
        "checks": message.checks_granted,
    }


def driver(message: m.DriverState) -> Fields:
    """Mode of the driver, and the number of commands that it refused by reason."""
    refused = dict(zip(message.refused_reasons, message.refused_counts, strict=False))
    reason = reason_text(message.reason, message.detail)
    return {"mode": message.mode, "reason": reason, "refused": refused}


def numbers(message: m.Message) -> dict[str, float | None]:
    """Every number of any message by name; elements of a tuple are named by a tuple of strings of equal length."""
    declared = [f.name for f in fields(cast(Any, message))]
    values = {name: getattr(message, name) for name in declared if name != "stamp_ns"}
    labels = [v for v in values.values() if isinstance(v, tuple) and v and all(isinstance(i, str) for i in v)]
    series: dict[str, float | None] = {}
    for name, value in values.items():
        if isinstance(value, bool | str):
            continue
        if isinstance(value, int | float):
            series[name] = number(value)
        elif isinstance(value, tuple) and value and all(isinstance(i, int | float) for i in value):
            names = next((label for label in labels if len(label) == len(value)), None)
            series |= {f"{name} {names[i] if names else i}": number(v) for i, v in enumerate(value)}
    return series


def _cost(value: float) -> float | None:
    """A cost; None if it is INVALID, which is an infinite or a negative number in a message."""
    return number(value) if value >= 0 else None


def _parameter(message: m.Parameter) -> Fields:
    return {
        "name": message.name,
        "quantity": message.name.removesuffix("g"),
        "id": message.id,
        "place": message.label,
        "unit": message.unit,
        "bound": message.bound,
        "lower": number(message.lower),
        "upper": number(message.upper),
        "value": number(message.value),
    }
