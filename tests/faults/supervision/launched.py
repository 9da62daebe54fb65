"""A recorded system that `tailor up` started, as an observer on its bus sees it."""

import os
import signal
import time
from contextlib import contextmanager

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import ProcessStates
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.bus_system import answers, free_endpoint
from tests.support.patience import is_alive, wait_until


class Launched:
    """One system: its launcher `up`, what that prints (`log`), the recording, and the newest message of each kind."""

    def __init__(self, up, session, log, recording):
        self.up, self.log, self.recording = up, log, recording
        self.inbox = session.inbox(("processes", "driver", "truth"), "agilo")
        self.latest = {}

    def poll(self):
        self.latest.update((type(sample.message), sample.message) for sample in self.inbox.drain())
        return self.latest

    def process(self, name):
        states = self.poll().get(ProcessStates)
        return next((state for state in states.processes if state.name == name), None) if states else None

    def moves(self):
        truth = self.poll().get(SoccerGroundTruth)
        return truth is not None and abs(truth.v) + abs(truth.omega) > 0.2

    def freeze(self, name):
        """Stop a child; seconds until it is gone."""
        wait_until(self.moves, "robot moves")
        self.latest.clear()
        pid = wait_until(lambda: self.process(name), name).pid
        os.kill(pid, signal.SIGSTOP)
        began_s = time.monotonic()
        wait_until(lambda: not is_alive(pid), "end of the frozen process", 30.0)
        return time.monotonic() - began_s


@contextmanager
def launched(folder, *flags):
    """Runs a soccer robot on its way, recorded in a folder."""
    endpoint, recording = free_endpoint(), folder / "run.mcap"
    words = tailor("up", "soccer", "--scenario", "waypoints", "--connect", endpoint, "--record", str(recording), *flags)
    with (folder / "log").open("w") as log:
        up = Child("up", words, log)
    try:
        wait_until(lambda: answers(endpoint), "router")
        with open_client(endpoint) as session:
            yield Launched(up, session, folder / "log", recording)
    finally:
        up.stop()
