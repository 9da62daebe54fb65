"""When hardware counts as faulty, and when it is opened again. Pure: every call receives the monotonic time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tailor.schemas.topics import TOPICS

FIRST_S = 3.0  # from opening to the first message of each watched sensor


@dataclass(frozen=True, slots=True)
class RetryPolicy:
    """How often hardware is opened again after faults that follow each other.

    Attributes:
      first_s: Pause after the first fault.
      factor: Each further pause is longer by this.
      most_s: Longest pause. Hardware that has worked for longer starts anew with `first_s`.
      attempts: Faults in a row after which the driver ends; 0: never.
    """

    first_s: float = 1.0
    factor: float = 2.0
    most_s: float = 10.0
    attempts: int = 0

    def pause_s(self, faults: int) -> float | None:
        """Pause after so many faults in a row; None: no further attempt."""
        if self.attempts and faults >= self.attempts:
            return None
        return float(min(self.most_s, self.first_s * self.factor ** min(faults - 1, 60)))


def watched_sensors(names: Iterable[str]) -> dict[str, float]:
    """Sensors whose silence stops the robot, with the limit in seconds: those that feed the control of motion.

    They are the topics of a driver with raised priority and a freshness limit, such as `odom` and `joint_states`.
    """
    topics = ((name, TOPICS[name]) for name in names)
    return {
        name: t.fresh_s for name, t in topics if t.fresh_s and t.priority == "interactive_high" and name != "driver"
    }


FOREVER = RetryPolicy()


class SensorWatch:
    """Ages of the watched sensors since the hardware was opened."""

    def __init__(self, limits_s: Mapping[str, float]) -> None:
        self._limits_s = dict(limits_s)
        self._heard_ns: dict[str, int] = {}
        self._refused: dict[str, str] = {}
        self._since_ns = 0

    def restart(self, now_ns: int) -> None:
        """The hardware has been opened."""
        self._heard_ns, self._refused, self._since_ns = {}, {}, now_ns

    def heard(self, topic: str, at_ns: int) -> None:
        """A measurement came."""
        self._heard_ns[topic] = at_ns
        self._refused.pop(topic, None)

    def refused(self, topic: str, reason: str) -> None:
        """A measurement came that no receiver takes, e.g. since it is not finite; it counts as none."""
        self._refused[topic] = reason

    def missing(self) -> str:
        """Watched sensors that have not been heard yet, as text."""
        return ", ".join(name for name in self._limits_s if name not in self._heard_ns)

    def fault(self, now_ns: int) -> str:
        """A sensor that is silent, or refused, for too long; empty if there is none."""
        for name, limit_s in self._limits_s.items():
            since_ns = self._heard_ns.get(name, self._since_ns)
            allowed_s = limit_s if name in self._heard_ns else max(FIRST_S, limit_s)
            if now_ns - since_ns > allowed_s * 1e9:
                return f"{name}: {self._refused.get(name, 'silent')} for {allowed_s:g} s"
        return ""
