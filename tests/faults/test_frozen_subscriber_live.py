"""A subscriber that reads nothing any more, as after Ctrl-Z, holds up nobody but itself."""

import os
import signal
import threading
import time
from contextlib import ExitStack

import pytest

from tailor.runtime.bus.attachment import UNSIGNED
from tailor.runtime.bus.opening import open_client
from tests.support.bus_system import bus_system
from tests.support.patience import wait_until

LIMIT_S = 1.0  # the router waited for it for 5 s; a busy machine takes some time as well
PLAYERS = 3  # more than zenoh has threads that read
ODOMETRY = "nav_msgs/msg/Odometry"


@pytest.mark.promise("P38")
@pytest.mark.xdist_group("live")
def test_an_estop_gets_past_a_replay_to_a_subscriber_that_reads_nothing(tmp_path):
    with bus_system() as (session, endpoint, start), ExitStack() as stack:
        recorder = start("tailor.tools.main", "record", "--quiet", "-o", tmp_path / "r.mcap", "--connect", endpoint)
        sessions = [stack.enter_context(open_client(endpoint, role="player")) for _ in range(PLAYERS)]
        players = [each.player("agilo/odom", ODOMETRY) for each in sessions]
        for player in players:
            wait_until(player.matched, "the recorder")
        estops = session.inbox(["estop"], "")
        button = stack.enter_context(open_client(endpoint, role="people")).publisher("estop", "")
        wait_until(button.matched, "a listener")
        os.kill(recorder.pid, signal.SIGSTOP)
        for player in players:
            threading.Thread(target=played, args=(player,), daemon=True).start()
        time.sleep(0.3)  # by now the queue to the recorder is full
        began_s = time.monotonic()
        button.publish_encoded(b"\0\1\0\0\1")
        wait_until(estops.drain, "the e-stop")
        assert time.monotonic() - began_s <= LIMIT_S
        recorder.kill()


def played(player):
    """Publish 10 MB, which no queue holds."""
    for _ in range(1000):
        player.put_raw(bytes(10_000), UNSIGNED)
