"""Stop every driver at once; each stays stopped until `tailor arm ROBOT --reset`."""

from __future__ import annotations

import argparse
import time

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.publisher import Publisher
from tailor.schemas.codec import decode
from tailor.schemas.messages import DriverState, EStop
from tailor.schemas.topics import TOPICS
from tailor.tools.cli.endpoint import configure_bus, endpoint_of

WAIT_S = 1.5  # for every driver to confirm; drivers publish at 10 Hz
REPEAT_S = 0.1  # a publication may be lost


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor estop`."""
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if every driver on the bus has stopped, 1 if one has not or there is none."""
    with open_client(endpoint_of(arguments)) as session:
        queue, subscription = session.subscribe_all(TOPICS["driver"].key.format(robot="*"))
        modes = _stop(session.publisher("estop", ""), queue)
        subscription.undeclare()
    for robot, mode in sorted(modes.items()):
        print(f"{robot} is {mode}")
    if not modes:
        print("no driver is on the bus")
    return 0 if modes and set(modes.values()) == {"estopped"} else 1


def _stop(publisher: Publisher, queue: IngestQueue) -> dict[str, str]:
    """Send the emergency stop repeatedly for WAIT_S; returns the mode of each robot's driver."""
    modes: dict[str, str] = {}
    ends = time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        publisher.publish(EStop(True))
        time.sleep(REPEAT_S)
        for raw in queue.drain():
            state = decode(DriverState, raw.payload)
            if isinstance(state, DriverState):
                modes[raw.key.partition("/")[0]] = state.mode
    return modes
