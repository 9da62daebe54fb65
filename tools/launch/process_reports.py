"""Publishes the states of the launcher's processes: on change, and once a second."""

from __future__ import annotations

from dataclasses import replace

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.clock import wall_ns
from tailor.schemas.messages import ProcessState, ProcessStates
from tailor.tools.cli.live_status import Screen
from tailor.tools.launch.senders import Senders

PERIOD_NS = 1_000_000_000


class ProcessReports:
    """Publisher of the topic `processes`."""

    def __init__(self, publisher: Publisher, senders: Senders, screen: Screen) -> None:
        self._publisher, self._senders, self._screen = publisher, senders, screen
        self._published: tuple[ProcessState, ...] = ()  # without the time of silence
        self._due_ns = 0

    def publish(self, states: tuple[ProcessState, ...], now_ns: int) -> None:
        """Publish the states if they differ from the last ones in more than the time of silence, or are due."""
        states = tuple(replace(state, sender=self._senders.of(state.name)) for state in states)
        unchanging = tuple(replace(state, silent_s=0.0) for state in states)
        if unchanging == self._published and now_ns < self._due_ns:
            return
        self._published, self._due_ns = unchanging, now_ns + PERIOD_NS
        message = ProcessStates(wall_ns(), states)
        self._publisher.publish(message)
        self._screen.show(message)
