"""Stop every driver at once; each stays stopped until `tailor arm ROBOT --reset`."""

from __future__ import annotations

import argparse
import time

from runtime.session import open_client
from schemas.messages import EStop
from tools.deployment import configure_bus, deployment

WAIT_S = 1.0  # for a driver to be known to this session
REPEATS, APART_S = 3, 0.02  # against a publication that is lost


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor estop`."""
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 when some driver listens, 1 when none does."""
    with open_client(deployment(arguments).bus.endpoint) as session:
        outlet = session.publisher("estop", "")
        ends = time.monotonic() + WAIT_S
        while not outlet.matched() and time.monotonic() < ends:
            time.sleep(0.005)
        heard = outlet.matched()
        for _ in range(REPEATS):
            outlet.publish(EStop(True))
            time.sleep(APART_S)
    print("stopped" if heard else "no driver listens")
    return 0 if heard else 1
