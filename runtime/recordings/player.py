"""Sends recorded messages again at their times, byte for byte, with the sequence and sender that they had."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from tailor.runtime.bus.attachment import Origin
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.clock import Clock
from tailor.runtime.recordings.playback_clock import PlaybackClock
from tailor.runtime.recordings.recording import Recorded

SLICE_NS = 20_000_000  # how long a player sleeps before it looks at the keyboard again


@dataclass(slots=True)
class Played:
    """What a player did."""

    messages: int = 0
    bytes: int = 0
    lateness_ns: list[int] = field(default_factory=list)  # of every message that was due at a time


class Player:
    """Plays one pass over some messages."""

    def __init__(
        self,
        outlet: Callable[[str, str], Publisher],
        clock: Clock,
        watch: Callable[[PlaybackClock], bool],
        tick: Callable[[int], None] = lambda _: None,
        tick_ns: int = 0,
    ) -> None:
        """Make a player.

        Args:
          outlet: The publisher for a key and a ROS type.
          clock: Paces the messages.
          watch: Called a few dozen times a second with the pace, which it may change; False ends the playing.
          tick: Called with the recorded time every `tick_ns` of real time; publishes /clock.
          tick_ns: 0 for never.
        """
        self.played = Played()
        self._outlet, self._clock, self._watch = outlet, clock, watch
        self._tick, self._tick_ns, self._next_tick_ns = tick, tick_ns, 0

    def play(self, messages: Iterable[Recorded], playback: PlaybackClock) -> bool:
        """Send the messages, in their order; False if `watch` ended it."""
        for recorded in messages:
            if not self._wait(recorded.log_ns, playback):
                return False
            self._send(recorded)
        return True

    def _wait(self, recorded_ns: int, playback: PlaybackClock) -> bool:
        while self._watch(playback):
            now_ns = self._clock.now_ns()
            self._tick_when_due(now_ns, playback)
            due_ns = playback.due_ns(recorded_ns)
            if due_ns is None:
                if playback.take_step(recorded_ns):
                    return True
                self._clock.sleep_until(now_ns + SLICE_NS)
            elif now_ns >= due_ns:
                self.played.lateness_ns.append(now_ns - due_ns)
                return True
            else:
                self._clock.sleep_until(min(due_ns, now_ns + SLICE_NS, self._next_tick_ns or due_ns))
        return False

    def _tick_when_due(self, now_ns: int, playback: PlaybackClock) -> None:
        if self._tick_ns and now_ns >= self._next_tick_ns:
            self._tick(playback.recorded_ns(now_ns))
            self._next_tick_ns = now_ns + self._tick_ns

    def _send(self, recorded: Recorded) -> None:
        origin = Origin(recorded.sequence, recorded.publish_ns, recorded.sender)
        self._outlet(recorded.key, recorded.ros_type).put_raw(recorded.data, origin)
        self.played.messages += 1
        self.played.bytes += len(recorded.data)
