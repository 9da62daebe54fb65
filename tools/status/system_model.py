"""What an observer knows of a running system, fed with publications and their arrival times. Pure and bounded."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.runtime.bus.inbox import Raw
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import DriverState, ExecStatus, ProcessStates, Provenance, TickReport
from tailor.schemas.topics import Topic
from tailor.tools.status.arrivals import Arrivals
from tailor.tools.status.drivers import DriverRecord
from tailor.tools.status.executives import Executives
from tailor.tools.status.foreign import ForeignCounts
from tailor.tools.status.health import findings
from tailor.tools.status.picture import LauncherView, Picture, TopicView
from tailor.tools.status.reading import Received, read, topic_by_ending

SLOW_SHARE = 0.75  # of the topic's rate; at half of it no new action starts
LAUNCHER_SILENCE_S = 3.0  # it publishes once a second
MAX_ROBOTS = 16  # with their topics; a stranger could invent any number


class SystemModel:
    """Collects publications; `picture` is what they show at a moment.

    Attributes:
      foreign: Counters of what is no message of ours.
    """

    def __init__(self, now_ns: int) -> None:
        """`now_ns`: monotonic time, as in all other calls."""
        self.foreign = ForeignCounts()
        self._began_ns = now_ns
        self._arrivals: dict[str, Arrivals] = {}  # by key
        self._newest: dict[str, tuple[str, int]] = {}  # (sender, sequence), by key
        self._robots: set[str] = set()
        self._drivers: dict[str, DriverRecord] = {}
        self._executives = Executives()
        self._launched: tuple[ProcessStates, int] | None = None  # with its arrival

    def take(self, raw: Raw, now_ns: int) -> None:
        """Take a publication that arrived at `now_ns`."""
        received = read(raw)
        if received is None:
            self.foreign.unknown(raw.key)
        elif isinstance(received, Rejected):
            self.foreign.refused(raw.key, received.reason, received.where)
        elif received.origin.sequence and self._newest.get(raw.key) == _number(received):
            self.foreign.refused(raw.key, "repeated")  # of a frozen sender: it must not look fresh
        elif received.robot and not self._know(received.robot):
            self.foreign.unknown(raw.key)
        else:
            self._newest[raw.key] = _number(received)
            self._arrivals.setdefault(raw.key, Arrivals()).add(now_ns, received.origin.sender)
            self._update(received, now_ns)

    def incomplete(self, now_ns: int) -> bool:
        """Whether a live executive has not published what it requires, or a live system no launcher, yet.

        Both are published once a second; a system started by hand has no launcher.
        """
        return self._executives.unknown(now_ns) or (self._launched is None and bool(self._arrivals))

    def picture(self, now_ns: int) -> Picture:
        """State of the system at `now_ns`."""
        executives = self._executives.views(now_ns)
        senders = {executive.sender for executive in executives if not executive.silent}
        drivers = tuple(record.view(robot, now_ns, senders) for robot, record in sorted(self._drivers.items()))
        rates_hz = {key: rate_hz for each in executives if not each.silent for key, rate_hz in each.required.items()}
        topics = tuple(_topic_view(key, each, rates_hz, now_ns) for key, each in sorted(self._arrivals.items()))
        foreign = self.foreign.view()
        launcher = None if self._launched is None else _launcher_view(*self._launched, now_ns)
        observed_s = round((now_ns - self._began_ns) / 1e9, 3)
        problems = findings(executives, drivers, launcher, topics, foreign, observed_s)
        return Picture(
            healthy=not problems,
            problems=problems,
            observed_s=observed_s,
            executives=executives,
            restarts=self._executives.restarts,
            drivers=drivers,
            launcher=launcher,
            topics=topics,
            foreign=foreign,
        )

    def _know(self, robot: str) -> bool:
        if robot not in self._robots and len(self._robots) < MAX_ROBOTS:
            self._robots.add(robot)
        return robot in self._robots

    def _update(self, received: Received, now_ns: int) -> None:
        message, sender = received.message, received.origin.sender
        if isinstance(message, DriverState):
            self._drivers.setdefault(received.robot, DriverRecord()).update(message, now_ns)
        elif isinstance(message, ExecStatus):
            self._executives.status(sender, message, now_ns)
        elif isinstance(message, TickReport):
            self._executives.tick(sender, message, now_ns)
        elif isinstance(message, Provenance):
            self._executives.provenance(sender, message)
        elif isinstance(message, ProcessStates):
            self._launched = message, now_ns


def _number(received: Received) -> tuple[str, int]:
    return received.origin.sender, received.origin.sequence


def _launcher_view(states: ProcessStates, at_ns: int, now_ns: int) -> LauncherView:
    age_s = max(0, now_ns - at_ns) / 1e9
    return LauncherView(round(age_s, 3), age_s > LAUNCHER_SILENCE_S, states.processes)


def _topic_view(key: str, arrivals: Arrivals, rates_hz: Mapping[str, float], now_ns: int) -> TopicView:
    topic = _topic(key)
    nominal_hz = rates_hz.get(key, topic.rate_hz)
    needed = topic.fresh_s is not None  # commands rest while nobody is armed, and a ball may be out of sight
    periodic = nominal_hz > 0  # of other topics a rate states nothing: silence of hours is as right as three at once
    age_s, rate_hz = arrivals.age_s(now_ns), arrivals.rate_hz(now_ns) if periodic else None
    return TopicView(
        key=key,
        received=arrivals.count,
        age_s=round(age_s, 3),
        published="periodically" if periodic else "on change",
        rate_hz=None if rate_hz is None else round(rate_hz, 2),
        nominal_hz=nominal_hz,
        stale_after_s=topic.fresh_s,
        stale=topic.fresh_s is not None and age_s > topic.fresh_s,
        slow=needed and rate_hz is not None and rate_hz < SLOW_SHARE * nominal_hz,
        senders=arrivals.senders(now_ns),
    )


def _topic(key: str) -> Topic:
    topic = topic_by_ending(key)
    assert topic is not None, "only such keys are recorded"
    return topic
