"""Reduces recorded runs to what is compared: commands, plans, subgoals and durations of the actions."""

from __future__ import annotations

import dataclasses
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tailor.executive import domains
from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.interfaces.values import Array
from tailor.runtime.recordings.recording import Recorded
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of_robot
from tailor.schemas.messages import ActionFinished, ExecStatus, JointCommand, PlanReport, Subgoals, VelocityCommand
from tailor.schemas.messages.message import Message
from tailor.schemas.reason_text import result_text
from tailor.schemas.topics import TOPICS
from tailor.tools.cli.plain_text import plain
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.recordings.executive_run import RecordedRun, decoded
from tailor.tools.recordings.recorded_run import RecordedRuns

COMMANDS = tuple(t.key.removeprefix("{robot}") for t in TOPICS.values() if t.priority == "real_time")


@dataclass(frozen=True, slots=True)
class ComparedRun:
    """Run of one executive, reduced to the compared quantities."""

    name: str
    actions: tuple[ActionFinished, ...]
    plans: tuple[PlanReport, ...]
    subgoals: tuple[Subgoals, ...]
    axes: tuple[str, ...]  # of the commands, outlet by outlet, with units: "v [m/s]"
    commands: Array  # shape (n, 1 + axes): seconds since the first motion, values
    result: str

    @property
    def total_s(self) -> float:
        """Sum of the durations of all actions."""
        return sum(action.actual_s for action in self.actions)


def compared_run(path: Path) -> ComparedRun:
    """First run in a recording; a damaged file and further runs are warned of.

    Raises:
      UsageError: The file is not a recording, holds no run, or a message of the run is damaged.
    """
    runs = RecordedRuns(path)
    warn(path, runs.damage)
    if (count := len(runs.runs)) > 1:
        compared = f"the first one, of executive {runs.runs[0].sender[:8]}, is compared"
        print(f"{plain(path.name)} holds {count} runs: {compared}", file=sys.stderr)
    try:
        return _compared(path.stem, runs.runs[0])
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def _compared(name: str, run: RecordedRun) -> ComparedRun:
    status = _published(run, "status", ExecStatus)
    results = [result_text(s.result, s.result_reason, s.result_detail) for s in status if s.result]
    axes, commands = _commands(run)
    return ComparedRun(
        name=name,
        actions=tuple(_published(run, "finished", ActionFinished)),
        plans=tuple(_published(run, "plan", PlanReport)),
        subgoals=tuple(_published(run, "subgoals", Subgoals)),
        axes=axes,
        commands=commands,
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
    """Differences of the commands of two runs, matched by the time since the first motion.

    Returns:
      seconds: Duration of the shorter run; first_s: time of the first difference (nan if there is none); rms, max: of
      the difference over all axes, in their units. All but the duration are nan if no axis is of both runs.
    """
    count = min(len(a.commands), len(b.commands))
    width = min(a.commands.shape[1], b.commands.shape[1])
    difference = np.abs(a.commands[:count, 1:width] - b.commands[:count, 1:width])
    different = np.flatnonzero(difference.any(axis=1))
    seconds = float(a.commands[count - 1, 0]) if count else 0.0
    if a.axes and b.axes and not set(a.axes) & set(b.axes):
        return {"seconds": seconds, **dict.fromkeys(("first_s", "rms", "max"), float("nan"))}
    return {
        "seconds": seconds,
        "first_s": float(a.commands[different[0], 0]) if different.size else float("nan"),
        "rms": float(np.sqrt(np.mean(difference**2))) if count else 0.0,
        "max": float(difference.max()) if count else 0.0,
    }


def _published(run: RecordedRun, topic: str, kind: type) -> list[Any]:
    messages = (decoded(recorded) for recorded in run.published.get(TOPICS[topic].key, ()))
    return [message for message in messages if isinstance(message, kind)]


def _commands(run: RecordedRun) -> tuple[tuple[str, ...], Array]:
    """Names of the axes of all outlets, and their commands from the first motion on."""
    keys = sorted(key for key in run.published if key.endswith(COMMANDS))
    outlets = [outlet for outlet in (_Outlet.of(run, key) for key in keys) if len(outlet.rows)]
    if not outlets:
        return (), np.zeros((0, 1))
    times = max((outlet.rows[:, 0] for outlet in outlets), key=len)
    table = np.column_stack([times, *(outlet.at(times) for outlet in outlets)])
    velocities = np.concatenate([[False], *([outlet.velocity] * len(outlet.names) for outlet in outlets)])
    in_motion = np.where(velocities, table != 0, table != table[0])[:, 1:].any(axis=1)
    moving = np.flatnonzero(in_motion)
    table = table[moving[0] :] if moving.size else table[:0]
    if len(table):
        table[:, 0] -= table[0, 0]
    units = _units(keys[0].partition("/")[0])
    names = (name for outlet in outlets for name in outlet.names)
    return tuple(f"{name} [{units[name]}]" if units.get(name) else name for name in names), table


def _units(robot: str) -> dict[str, str]:
    """Units of a robot's axes by name; none where it is not installed."""
    try:
        domain = domains.load(spec_of_robot(robot).name)
    except UsageError:
        return {}
    return {axis.name: axis.unit for axis in domain.axes}


@dataclass(frozen=True, slots=True)
class _Outlet:
    """Commands of one topic: names of its axes, whether zero is rest on them, rows of seconds and values."""

    names: tuple[str, ...]
    velocity: bool
    rows: Array

    @classmethod
    def of(cls, run: RecordedRun, key: str) -> _Outlet:
        recorded = [(_time_s(r, message := decoded(r)), message) for r in run.published[key]]
        values = [(at_s, _values(message)) for at_s, message in recorded if isinstance(message, Message)]
        names = tuple(values[0][1]) if values else ()
        rows = [(at_s, *named.values()) for at_s, named in values if tuple(named) == names]
        velocity = any(isinstance(message, VelocityCommand | JointCommand) for _, message in recorded)
        return cls(names, velocity, np.array(rows, dtype=np.float64).reshape(len(rows), -1))

    def at(self, times: Array) -> Array:
        """Values in force half a period after these times: outlets of one tick are published one after another."""
        newest = np.searchsorted(self.rows[:, 0], times + PERIOD_NS / 2e9, side="right") - 1
        return self.rows[np.maximum(newest, 0), 1:]


def _time_s(recorded: Recorded, message: Message) -> float:
    """When a command was made, by the clock of its executive, which never goes back; if unstated, when it came."""
    return (getattr(message, "stamp_ns", 0) or recorded.log_ns) / 1e9


def _values(message: Any) -> dict[str, float]:
    """Set-points by the name of their axis."""
    if isinstance(message, JointCommand):
        return dict(zip(message.names, message.velocities, strict=False))
    fields = {field.name: getattr(message, field.name) for field in dataclasses.fields(message)}
    return {name: value for name, value in fields.items() if isinstance(value, float)}
