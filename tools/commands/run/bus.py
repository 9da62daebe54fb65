"""Run only the bus router; every other process of a deployment connects to it."""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from tailor.runtime.bus.rights.folder_watch import RunFolderWatch
from tailor.runtime.malloc_settings import set_for_host
from tailor.runtime.processes.child import Child
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.processes.supervised import State
from tailor.runtime.processes.supervisor import Supervisor
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.bus_settings import BusSettings, configure_hosting, with_hosting_flags
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus
from tailor.tools.launch.hosting import gateways, hosted_bus

PERIOD_S = 0.05


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor bus`; the router listens at the endpoint that the others connect to."""
    configure_hosting(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Route until stopped; 1 if a gateway has ended for good, or the folder of the bus was removed."""
    notifier = Notifier.from_environment()
    settings = with_hosting_flags(bus_settings(arguments), arguments)
    stop = stop_on_signals()
    set_for_host()
    with hosted_bus(settings, note), tempfile.TemporaryDirectory(prefix="tailor-") as folder:
        supervisor = Supervisor(note, lambda name, argv: Child(name, argv, notify_folder=Path(folder)))
        try:
            for spec in gateways(settings):
                supervisor.start(spec, time.monotonic_ns())
            return _route(supervisor, settings, notifier, stop)
        finally:
            notifier.stopping()
            supervisor.stop()


def _route(supervisor: Supervisor, settings: BusSettings, notifier: Notifier, stop: Stop) -> int:
    names = [spec.name for spec in gateways(settings)]
    ready, folder = False, RunFolderWatch(settings.endpoint)
    while not stop.requested:
        supervisor.poll(time.monotonic_ns())
        states = [supervisor.state(name) for name in names]
        if State.ENDED in states:
            return 1
        if failure := folder.failure():
            note(failure)
            return 1
        if not ready and State.STARTING not in states:
            ready = True
            note(f"routing at {settings.endpoint}; Ctrl-C ends it")
            notifier.ready()
        notifier.alive()
        time.sleep(PERIOD_S)
    return 0
