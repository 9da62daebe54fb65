"""Stop every driver at once; each stays stopped until `tailor arm ROBOT --reset`."""

from __future__ import annotations

import argparse
import time

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import open_client
from tailor.schemas.codec import decode
from tailor.schemas.messages import DriverState, EStop
from tailor.schemas.topics import TOPICS
from tailor.tools.cli.endpoint import configure_bus, endpoint_of

WAIT_S = 1.5  # for every driver to confirm; they speak at 10 Hz
AGAIN_S = 0.1  # until all have, repeat it: a publication may be lost


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor estop`."""
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 when every driver that speaks has stopped, 1 when one has not or none speaks."""
    with open_client(endpoint_of(arguments)) as session:
        intake, subscribe_all = session.subscribe_all(TOPICS["driver"].key.format(robot="*"))
        modes = _stop(session.publisher("estop", ""), intake)
        subscribe_all.undeclare()
    for robot, mode in sorted(modes.items()):
        print(f"{robot} is {mode}")
    if not modes:
        print("no driver speaks")
    return 0 if modes and set(modes.values()) == {"estopped"} else 1


def _stop(outlet: Publisher, intake: IngestQueue) -> dict[str, str]:
    """Each robot's mode after the e-stop was sent, repeatedly, for WAIT_S."""
    modes: dict[str, str] = {}
    ends = time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        outlet.publish(EStop(True))
        time.sleep(AGAIN_S)
        for raw in intake.take():
            state = decode(DriverState, raw.payload)
            if isinstance(state, DriverState):
                modes[raw.key.partition("/")[0]] = state.mode
    return modes
