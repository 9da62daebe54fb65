"""A soccer robot on a bus, as a session of people sees it: last driver state, status and truth."""

import time

from tailor.schemas.messages.soccer import SoccerGroundTruth

QUIET_S = 2.0  # so long nothing may move; an executive with an open goal asks, or moves, within half a second


class WatchedRobot:
    """The latest message of each type, and the highest speed since it was last set to zero."""

    def __init__(self, session):
        self.inbox = session.inbox(("driver", "status", "truth"), "agilo")
        self.latest, self.fastest_mps = {}, 0.0

    def poll(self):
        for sample in self.inbox.drain():
            self.latest[type(sample.message)] = sample.message
            if isinstance(sample.message, SoccerGroundTruth):
                self.fastest_mps = max(self.fastest_mps, abs(sample.message.v), abs(sample.message.omega))
        return self.latest

    def at_rest(self):
        truth = self.poll().get(SoccerGroundTruth)
        return truth is not None and abs(truth.v) < 0.01 and abs(truth.omega) < 0.01

    def fastest_in(self, seconds):
        """The highest speed of the next seconds."""
        self.fastest_mps, ends = 0.0, time.monotonic() + seconds
        while time.monotonic() < ends:
            self.poll()
            time.sleep(0.01)
        return self.fastest_mps
