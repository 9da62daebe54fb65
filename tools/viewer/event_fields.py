"""One message into the fields that the page draws: JSON values, rounded, in the units of the message.

Pure. Which of them are worth telling, and when, is story.py's business.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.schemas.reason_text import reason_text

Fields = dict[str, Any]  # JSON values only

DIGITS = 4  # a tenth of a millimetre, and fewer bytes
FAR_M = 20.0  # a ball this far away: a scenario without a ball
MS = 1e-6  # of a nanosecond


def number(value: float) -> float | None:
    """The value rounded; None, which JSON knows, for what is not finite."""
    return round(float(value), DIGITS) if math.isfinite(value) else None


def truth(message: SoccerGroundTruth) -> Fields:
    """The simulator's robot and ball."""
    row = _pose(message.x, message.y, message.phi, message.v)
    if math.hypot(message.ball_x, message.ball_y) < FAR_M:
        row["ball"] = [number(message.ball_x), number(message.ball_y)]
    return row


def odometry(message: m.Odometry) -> Fields:
    """The dead-reckoned robot."""
    return _pose(message.x, message.y, message.phi, message.v)


def seen(message: m.PoseEstimate) -> Fields:
    """The robot as the camera sees it; a picture tells no speed."""
    return _pose(message.x, message.y, message.phi, 0.0)


def believed(names: tuple[str, ...], values: tuple[float, ...]) -> Fields | None:
    """The robot on the plane, and the ball, as the belief's names tell them; None for a robot that is no point."""
    said = {name.partition(" (")[0].replace(" ", "_"): value for name, value in zip(names, values, strict=False)}
    if not {"x", "y", "phi"} <= said.keys():
        return None
    row = _pose(said["x"], said["y"], said["phi"], said.get("v", 0.0))
    seen_once = said.get("ball_sigma", 0.0) >= 0  # a ball never seen has a deviation of -1
    if seen_once and {"ball_x", "ball_y"} <= said.keys() and math.hypot(said["ball_x"], said["ball_y"]) < FAR_M:
        row["ball"] = [number(said["ball_x"]), number(said["ball_y"])]
    return row


def action(message: m.InstantiatedAction) -> Fields:
    """An action with its parameters; `place` is a parameter's label, `quantity` its name without the goal's g."""
    return {
        "action": message.action,
        "step": message.step,
        "asserted": message.asserted,
        "predicted": number(message.predicted_s),
        "spread": number(message.spread_s),
        "parameters": [_parameter(p) for p in message.parameters],
    }


def subgoals(message: m.Subgoals) -> Fields:
    """The sequence that is being executed."""
    actions = [action(a) for a in message.actions]
    return {"tick": message.tick, "horizon": message.horizon, "actions": actions}


def refinement(message: m.RefinementReport) -> Fields:
    """The search behind the subgoals, with the best value over the evaluations."""
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
        "pSlowdown": number(message.p_slowdown) if message.p_slowdown >= 0 else None,
        "keptGreedy": message.kept_greedy,
        "gap": number(message.gap_pct) if message.gap_pct >= 0 else None,
        "trace": [[evaluations, number(best_s)] for evaluations, best_s in trace],
    }


def finished(message: m.ActionFinished) -> Fields:
    """How an action ended."""
    return {
        "action": message.action,
        "index": message.action_index,
        "outcome": message.outcome,
        "reason": message.reason,
        "predicted": number(message.predicted_s),
        "actual": number(message.actual_s),
    }


def tick(message: m.TickReport) -> Fields:
    """Timing of a tick in milliseconds, and the checks that its deliberation was granted."""
    return {
        "tick": message.tick,
        "late": number(message.lateness_ns * MS),
        "control": number(message.control_ns * MS),
        "work": number(message.work_ns * MS),
        "skipped": message.skipped,
        "checks": message.checks_granted,
    }


def driver(message: m.DriverState) -> Fields:
    """What the driver says of itself."""
    refused = dict(zip(message.refused_reasons, message.refused_counts, strict=False))
    reason = reason_text(message.reason, message.detail)
    return {"mode": message.mode, "reason": reason, "refused": refused}


def numbers(message: m.Message) -> dict[str, float | None]:
    """Every number of any message by name; a tuple's elements are named by a tuple of strings as long as it is."""
    values = {f.name: getattr(message, f.name) for f in fields(message) if f.name != "stamp_ns"}
    labels = [v for v in values.values() if isinstance(v, tuple) and v and all(isinstance(i, str) for i in v)]
    found: dict[str, float | None] = {}
    for name, value in values.items():
        if isinstance(value, bool | str):
            continue
        if isinstance(value, int | float):
            found[name] = number(value)
        elif isinstance(value, tuple) and value and all(isinstance(i, int | float) for i in value):
            named = next((label for label in labels if len(label) == len(value)), None)
            found |= {f"{name} {named[i] if named else i}": number(v) for i, v in enumerate(value)}
    return found


def _cost(value: float) -> float | None:
    """A cost; None where it is INVALID, which a message says as infinite or, as floats must be finite, as negative."""
    return number(value) if value >= 0 else None


def _pose(x: float, y: float, phi: float, v: float) -> Fields:
    return {"x": number(x), "y": number(y), "phi": number(phi), "v": number(v)}


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
