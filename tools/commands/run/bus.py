"""Run only the bus router; every other process of a deployment connects to it."""

from __future__ import annotations

import argparse
import time

from tailor.runtime.bus.opening import open_router
from tailor.runtime.stopping import stop_on_signals
from tailor.tools.cli.endpoint import configure_bus, endpoint_of


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor bus`; the router listens at the endpoint that the others connect to."""
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Route until stopped."""
    endpoint = endpoint_of(arguments)
    stop = stop_on_signals()
    with open_router(endpoint):
        print(f"routing at {endpoint}; Ctrl-C ends it", flush=True)
        while not stop.requested:
            time.sleep(0.1)
    return 0
