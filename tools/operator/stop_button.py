"""Stops every driver on the bus, and reports what each of them confirms.

Loads neither NumPy nor rosbags before the first e-stops are out: their 0.2 s would be motion.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from threading import Lock

from tailor.runtime.bus.attachment import sender_in
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.session import Session
from tailor.schemas.messages import DriverState
from tailor.schemas.topics import TOPICS

STOP = b"\0\1\0\0\1"  # CDR of EStop(True); the codec would have to be loaded first
WAIT_S = 1.5  # for every driver to confirm
HEAR_S = 0.35  # drivers publish at 10 Hz: whoever is there has been heard by then
REPEAT_S = 0.02  # a publication may be lost, e.g. before the router knows this publisher
FORGET_S = 2.0  # of a robot's drivers one that is silent: it has started anew; or has frozen, which one press waits for
FIRST_S = 0.05  # nothing else is done until then
MAX_READ = 500  # messages of one poll: a flood must not delay the next e-stop
ALL_DRIVERS = TOPICS["driver"].key.format(robot="*")


class DriverStates:
    """Newest state of every driver on the bus; a robot may have several, e.g. that of a forgotten simulator."""

    def __init__(self, queue: IngestQueue, now_s: Callable[[], float] = time.monotonic) -> None:
        """`queue`: publications on `*/driver`; `now_s`: monotonic seconds."""
        self._queue, self._now_s = queue, now_s
        self._drivers: dict[str, dict[str, tuple[DriverState, float]]] = {}  # with its time, by robot and sender

    @property
    def newest(self) -> dict[str, DriverState]:
        """By robot, the state of its driver; of several drivers that of one that is not stopped, if there is any."""
        return {robot: min(states, key=_is_stopped) for robot, states in self.all().items()}

    def all(self) -> dict[str, list[DriverState]]:
        """By robot, the states of all its drivers, in the order of their senders."""
        return {robot: [state for _, (state, _) in sorted(each.items())] for robot, each in self._drivers.items()}

    def poll(self) -> Collection[str]:
        """Take what has been received since the last call; of each driver only the newest valid state is read.

        Returns:
          Robots that were heard.
        """
        from tailor.schemas.codec import decode

        now_s, fresh = self._now_s(), dict[tuple[str, str], DriverState]()
        for raw in reversed(self._queue.drain()[-MAX_READ:]):
            driver = raw.key.rpartition("/")[0], sender_in(raw.attachment)
            if driver not in fresh and raw.is_put:
                state = decode(DriverState, raw.payload)
                if isinstance(state, DriverState):
                    fresh[driver] = state
        for (robot, sender), state in fresh.items():
            self._drivers.setdefault(robot, {})[sender] = state, now_s
        heard = {robot for robot, _ in fresh}
        for robot in heard:
            drivers = self._drivers[robot].items()
            self._drivers[robot] = {sender: each for sender, each in drivers if now_s - each[1] <= FORGET_S}
        return heard


def _is_stopped(state: DriverState) -> bool:
    return state.mode == "estopped"


@contextmanager
def driver_states(session: Session) -> Iterator[DriverStates]:
    """Subscribes to the states of all drivers."""
    queue, subscription = session.subscribe_all(ALL_DRIVERS)
    try:
        yield DriverStates(queue)
    finally:
        subscription.undeclare()


class StopButton:
    """Emergency stop of all drivers; may be pressed again, and from several threads."""

    def __init__(self, session: Session) -> None:
        """`session`: of a role that may publish the e-stop."""
        self._session = session
        self._publisher = session.publisher("estop", "")
        self._lock = Lock()

    def press(self, wait_s: float = WAIT_S, expected: Collection[str] = ()) -> dict[str, DriverState]:
        """Publish the e-stop until every driver that is heard, and each that is expected, confirms it.

        Args:
          wait_s: For that long at most.
          expected: Robots whose drivers are known to run: one that has frozen is not heard.

        Returns:
          The newest state of each driver, by robot; of several drivers that of one that is not stopped, if any.
        """
        with self._lock:
            began_s = time.monotonic()
            self._publisher.publish_encoded(STOP)
            with driver_states(self._session) as states:
                while (elapsed_s := time.monotonic() - began_s) < wait_s:
                    time.sleep(REPEAT_S)
                    self._publisher.publish_encoded(STOP)
                    if elapsed_s >= FIRST_S:
                        states.poll()
                    if elapsed_s >= HEAR_S and all_stopped(states.newest, expected):
                        break
                else:
                    states.poll()  # on a busy machine the first one may take all of the time, to load the codec
                return states.newest


def all_stopped(states: Mapping[str, DriverState], expected: Collection[str] = ()) -> bool:
    """Whether there is a driver, and every one, each of the expected robots' included, has latched the e-stop."""
    heard = bool(states) and states.keys() >= set(expected)
    return heard and all(map(_is_stopped, states.values()))


def summary(states: Mapping[str, DriverState], expected: Collection[str] = ()) -> str:
    """One line a driver: its mode, or that it is expected and not heard."""
    lines = {robot: f"{robot} is {state.mode}" for robot, state in states.items()}
    lines |= {robot: f"{robot} is SILENT: its state is unknown" for robot in expected if robot not in states}
    return "\n".join(line for _, line in sorted(lines.items())) or "no driver is on the bus"
