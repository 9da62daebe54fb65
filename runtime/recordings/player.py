"""Publishes recorded messages at their times, byte for byte, with their original sequence numbers and senders."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from tailor.runtime.bus.attachment import Origin
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.clock import Clock
from tailor.runtime.recordings.playback_clock import PlaybackClock
from tailor.runtime.recordings.recording import Recorded

MAX_LATENESSES = 100_000  # of the newest messages: a repeated playback has no end
SET_BACK_NS = 10_000_000_000  # from a message to the next; other recorders write some in another order
SLICE_NS = 20_000_000  # longest sleep between two polls of the keyboard


@dataclass(slots=True)
class PlaybackStats:
    """Counts and lateness of a playback."""

    messages: int = 0
    bytes: int = 0
    lateness_ns: deque[int] = field(default_factory=lambda: deque(maxlen=MAX_LATENESSES))  # of those with a due time


class Player:
    """Plays messages in order."""

    def __init__(
        self,
        publisher: Callable[[str, str], Publisher],
        clock: Clock,
        watch: Callable[[PlaybackClock], bool],
        tick: Callable[[int], None] = lambda _: None,
        tick_ns: int = 0,
    ) -> None:
        """Create a player.

        Args:
          publisher: Publisher for a key and a ROS type.
          clock: Clock of the due times.
          watch: Called with the playback clock a few dozen times a second; may change it; False ends the playback.
          tick: Called with the recorded time every `tick_ns` of real time; publishes /clock.
          tick_ns: 0 for never.
        """
        self.stats = PlaybackStats()
        self._publisher, self._clock, self._watch = publisher, clock, watch
        self._tick, self._tick_ns, self._next_tick_ns = tick, tick_ns, 0

    def play(self, messages: Iterable[Recorded], playback: PlaybackClock) -> bool:
        """Publish the messages in order; False if `watch` ended the playback.

        Where the recorder's clock was set back, recorded time goes on from there: all that follows would else be due.
        """
        before_ns = 0
        for recorded in messages:
            if recorded.log_ns < before_ns - SET_BACK_NS:
                playback.jump(recorded.log_ns, self._clock.now_ns())
            before_ns = recorded.log_ns
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
                self.stats.lateness_ns.append(now_ns - due_ns)
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
        self._publisher(recorded.key, recorded.ros_type).put_raw(recorded.data, origin)
        self.stats.messages += 1
        self.stats.bytes += len(recorded.data)
