"""Reduces recorded runs to what is compared: commands, plans, subgoals and durations of the actions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.schemas.messages import ActionFinished, ExecStatus, PlanReport, Subgoals
from tailor.schemas.reason_text import result_text
from tailor.schemas.topics import TOPICS
from tailor.tools.recordings.recorded_run import RecordedRun, RecordedRuns, decoded

COMMANDS = tuple(t.key.removeprefix("{robot}") for t in TOPICS.values() if t.priority == "real_time")


@dataclass(frozen=True, slots=True)
class ComparedRun:
    """Run of one executive, reduced to the compared quantities."""

    name: str
    actions: tuple[ActionFinished, ...]
    plans: tuple[PlanReport, ...]
    subgoals: tuple[Subgoals, ...]
    commands: NDArray[np.float64]  # shape (n, 1 + axes): seconds since the first command that is not zero, values
    result: str

    @property
    def total_s(self) -> float:
        """Sum of the durations of all actions."""
        return sum(action.actual_s for action in self.actions)


def compared_run(path: Path) -> ComparedRun:
    """First run in a recording.

    Raises:
      UsageError: The file is not a recording, or holds no run.
    """
    run = RecordedRuns(path).runs[0]
    status = _published(run, "status", ExecStatus)
    results = [result_text(s.result, s.result_reason, s.result_detail) for s in status if s.result]
    return ComparedRun(
        name=path.stem,
        actions=tuple(_published(run, "finished", ActionFinished)),
        plans=tuple(_published(run, "plan", PlanReport)),
        subgoals=tuple(_published(run, "subgoals", Subgoals)),
        commands=_commands(run),
        result=results[-1] if results else "",
    )


def chosen(subgoals: Subgoals) -> dict[str, float]:
    """Free variables of an action sequence, each under its first name: "action.parameter" -> chosen value."""
    named: dict[int, tuple[str, float]] = {}
    for action in subgoals.actions:
        for parameter in action.parameters:
            if not parameter.bound:  # parameters with equal ids are one variable (paper 6.2.2)
                named.setdefault(parameter.id, (f"{action.action}.{parameter.name}", parameter.value))
    return dict(named.values())


def command_differences(a: ComparedRun, b: ComparedRun) -> dict[str, float]:
    """Differences of the commands of two runs, matched by the time since the first command that is not zero.

    Returns:
      seconds: Duration of the shorter run; first_s: time of the first difference (nan if there is none); rms, max: of
      the difference over all axes, in their units.
    """
    count = min(len(a.commands), len(b.commands))
    width = min(a.commands.shape[1], b.commands.shape[1])
    difference = np.abs(a.commands[:count, 1:width] - b.commands[:count, 1:width])
    different = np.flatnonzero(difference.any(axis=1))
    return {
        "seconds": float(a.commands[count - 1, 0]) if count else 0.0,
        "first_s": float(a.commands[different[0], 0]) if different.size else float("nan"),
        "rms": float(np.sqrt(np.mean(difference**2))) if count else 0.0,
        "max": float(difference.max()) if count else 0.0,
    }


def _published(run: RecordedRun, topic: str, kind: type) -> list[Any]:
    messages = (decoded(recorded) for recorded in run.published.get(TOPICS[topic].key, ()))
    return [message for message in messages if isinstance(message, kind)]


def _commands(run: RecordedRun) -> NDArray[np.float64]:
    """Commands from the first one that is not zero."""
    keys = [key for key in run.published if key.endswith(COMMANDS)]
    rows = [(r.log_ns / 1e9, *_values(decoded(r))) for key in keys for r in run.published[key]]
    table = np.array(rows, dtype=np.float64).reshape(len(rows), -1) if rows else np.zeros((0, 1))
    moving = np.flatnonzero(table[:, 1:].any(axis=1))
    table = table[moving[0] :] if moving.size else table[:0]
    if len(table):
        table[:, 0] -= table[0, 0]
    return table


def _values(message: Any) -> tuple[float, ...]:
    return tuple(message.velocities) if hasattr(message, "velocities") else (message.v, message.omega)
