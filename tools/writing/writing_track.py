"""Track of a piece of writing, for drawings and measures: joint angles, waypoints and their times."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.letters import font
from tailor.executive.domains.arm.robot import JOINTS
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages import ActionFinished, ExecStatus, JointState, Message, MotorCurrents, Subgoals
from tailor.schemas.reason_text import result_text


@dataclass(frozen=True, slots=True)
class WritingTrack:
    """One run of the arm, from the start of its first reach until it rests at the last waypoint.

    Attributes:
      title: For pictures.
      text: The capitals to write.
      result: The executive's: "achieved", "failed: why", or "" if it was stopped.
      times_s: Since the start, shape (n,), about every 20 ms.
      angles: Pan and lift in rad, shape (n, 2), by the encoders.
      velocities: In rad/s, shape (n, 2).
      waypoints: In rad, shape (w, 2), in order.
      arrivals_s: When each waypoint was to be passed, shape (w,).
      predicted_s: Of each reach when it began, shape (w,).
      peak_current_a: The largest of both motors.
    """

    title: str
    text: str
    result: str
    times_s: Array
    angles: Array
    velocities: Array
    waypoints: Array
    arrivals_s: Array
    predicted_s: Array
    peak_current_a: float

    @property
    def duration_s(self) -> float:
        """From the start until the last waypoint; 0 if none was reached."""
        return float(self.arrivals_s[-1]) if len(self.arrivals_s) else 0.0

    def pen_down(self) -> NDArray[np.bool_]:
        """Whether the arm was writing, rather than on its way to a letter's first waypoint, shape (n,)."""
        down = np.zeros(len(self.times_s), dtype=bool)
        first = 0
        for letter in self.text:
            last = first + len(font()[letter]) - 1
            if last < len(self.arrivals_s):
                down |= (self.times_s > self.arrivals_s[first]) & (self.times_s <= self.arrivals_s[last])
            first = last + 1
        return down


def writing_track(title: str, text: str, messages: Iterable[Message]) -> WritingTrack:
    """Collect what was written from a run's messages, in whatever order its topics came."""
    kept = list(messages)
    statuses = [m for m in kept if isinstance(m, ExecStatus)]
    finished = [m for m in kept if isinstance(m, ActionFinished) and m.outcome == "done"]
    begun_ns = min((s.stamp_ns for s in statuses if s.action), default=0)
    # an action is done one period before its waypoint
    ended_ns = max((f.stamp_ns for f in finished), default=begun_ns) + round(PERIOD_S * 1e9)
    states = [m for m in kept if isinstance(m, JointState) and begun_ns <= m.stamp_ns <= ended_ns]
    states.sort(key=lambda state: state.stamp_ns)
    currents = [m for m in kept if isinstance(m, MotorCurrents) and begun_ns < m.stamp_ns <= ended_ns]
    plan = next((m for m in kept if isinstance(m, Subgoals)), None)
    return WritingTrack(
        title=title,
        text=text,
        result=next(filter(None, (_result(status) for status in reversed(statuses))), ""),
        times_s=np.array([(state.stamp_ns - begun_ns) * 1e-9 for state in states]),
        angles=_joints(states, "positions"),
        velocities=_joints(states, "velocities"),
        waypoints=_waypoints(plan),
        arrivals_s=np.array([(f.stamp_ns - begun_ns) * 1e-9 + PERIOD_S for f in finished]),
        predicted_s=np.array([f.predicted_s for f in finished]),
        peak_current_a=max((max(m.peak_amperes) for m in currents), default=0.0),
    )


def _result(status: ExecStatus) -> str:
    return result_text(status.result, status.result_reason, status.result_detail)


def _joints(states: list[JointState], field: str) -> Array:
    rows = [[getattr(state, field)[state.names.index(joint)] for joint in JOINTS] for state in states]
    return np.array(rows).reshape(len(rows), len(JOINTS))


def _waypoints(plan: Subgoals | None) -> Array:
    """The goals of the first sequence that was announced, which goes all the way."""
    goals = [{p.name: p.value for p in action.parameters} for action in (plan.actions if plan else ())]
    return np.array([[goal["ag"], goal["bg"]] for goal in goals]).reshape(len(goals), 2)
