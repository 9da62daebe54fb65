"""Stop every driver at once; each stays stopped until `tailor arm ROBOT --reset`.

With --hold this terminal becomes a dead man's switch: every driver that hears it stops when this program ends, however
it ends. Any key, Ctrl-C or closing the terminal ends it.

A driver that has frozen is not heard. With --expect ROBOT it counts as not stopped; every other driver is stopped, too.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from threading import Timer

from tailor.runtime.bus.session import Session
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState
from tailor.tools.cli.systems.endpoint import configure_bus, key_advice, open_bus
from tailor.tools.operator.stop_button import StopButton, all_stopped, summary

LOST = "NOT CONFIRMED: the bus was lost, and nobody knows what heard the e-stop; use the e-stop of the robot itself"
NOT_STOPPED = "NOT STOPPED: use the e-stop of the robot itself"
PATIENCE_S = 0.7  # for a bus; then people read what to do. A bus that starts just now is tried for longer


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor estop`."""
    parser.add_argument("--hold", action="store_true", help="hold a dead man's switch instead: releasing it stops")
    parser.add_argument(
        "--expect",
        metavar="ROBOT",
        nargs="+",
        default=[],
        help="robots whose drivers must confirm; without it, those that are heard. Every robot is stopped either way",
    )
    parser.add_argument("--json", action="store_true", help="print each driver's mode as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if every driver that is heard or expected has stopped, 1 if one has not or there is none."""
    with _bus(arguments) as session:
        button = StopButton(session)
        try:
            if arguments.hold:
                from tailor.tools.operator.dead_mans_switch import hold_in_terminal

                hold_in_terminal(session, sys.stderr if arguments.json else sys.stdout)
        finally:  # whatever ended it
            states = button.press(expected=arguments.expect)
        return _report(arguments, states, session.connected)  # a session whose router hangs takes seconds to close


@contextmanager
def _bus(arguments: argparse.Namespace) -> Iterator[Session]:
    """The session; who waits for it reads what to do meanwhile, and what to do instead if there is none."""
    late = f"{NOT_STOPPED}; no bus answers so far"
    notice = Timer(PATIENCE_S, lambda: print(late, file=sys.stderr, flush=True))
    notice.daemon = True
    with ExitStack() as stack:
        notice.start()
        try:
            session = stack.enter_context(open_bus(arguments, "people"))
        except UsageError as error:
            raise type(error)(f"{error}; {NOT_STOPPED}") from error
        finally:
            notice.cancel()
        yield session


def _report(arguments: argparse.Namespace, states: Mapping[str, DriverState], connected: bool) -> int:
    stopped = all_stopped(states, arguments.expect)
    lost = not stopped and not connected
    if arguments.json:
        print(_json(states, stopped), flush=True)
    elif states or not lost:
        print(summary(states, arguments.expect), flush=True)
    if stopped:
        return 0
    if lost:
        print(LOST, file=sys.stderr)
    if advice := key_advice(arguments, "stops drivers"):
        print(advice, file=sys.stderr)
    return 1


def _json(states: Mapping[str, DriverState], stopped: bool) -> str:
    import json  # after the e-stop

    modes = {robot: state.mode for robot, state in sorted(states.items())}
    return json.dumps({"stopped": stopped, "drivers": modes})
