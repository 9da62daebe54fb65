"""Arm a driver: it obeys the commands of one sender, by default of the running executive."""

from __future__ import annotations

import argparse
import re
import time

from tailor.runtime.bus.session import Session
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ArmRequest, DriverState, ExecStatus
from tailor.schemas.reason_text import reason_text
from tailor.tools.cli.endpoint import configure_bus, open_bus

WAIT_S = 2.0  # for the executive's status, and for the driver's state


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor arm`."""
    parser.add_argument("robot", nargs="?", default="agilo", help="robot of the driver (default agilo)")
    parser.add_argument("--off", action="store_true", help="disarm instead")
    parser.add_argument("--reset", action="store_true", help="also release a latched emergency stop")
    parser.add_argument(
        "--sender", metavar="HEX", help="sender to obey, 32 hex digits (default: the running executive)"
    )
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if the driver's state shows the request, 1 if not."""
    if not re.fullmatch(r"[\w-]+(/[\w-]+)*", arguments.robot, re.ASCII):
        raise UsageError(f"robot {arguments.robot!r}: expected a name, e.g. agilo")
    if arguments.sender and not re.fullmatch("[0-9a-f]{32}", arguments.sender):
        raise UsageError(f"--sender {arguments.sender}: expected 32 hex digits")
    with open_bus(arguments, "people") as session:
        sender = arguments.sender or ("" if arguments.off else _executive_sender(session))
        if not sender and not arguments.off:
            print("no executive is running, expected one or --sender")
            return 1
        request = ArmRequest(not arguments.off, arguments.reset, sender, 0)
        state = _send(session, arguments.robot, request)
    if state is None:
        print(f"the driver of {arguments.robot} does not respond")
        return 1
    cause = reason_text(state.reason, state.detail)
    print(f"{arguments.robot} is {state.mode}" + (f": {cause}" if cause else ""))
    return 0 if _done(state, request) else 1


def _executive_sender(session: Session) -> str:
    """Sender id of the executive that publishes its status; empty if none does in time."""
    inbox = session.inbox(["status"], "")
    ends = time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        for sample in inbox.drain():
            if isinstance(sample.message, ExecStatus):
                return sample.sender
        time.sleep(0.02)
    return ""


def _send(session: Session, robot: str, request: ArmRequest) -> DriverState | None:
    """Send a request and return the driver's last state, at the latest after WAIT_S."""
    inbox, publisher = session.inbox(["driver"], robot), session.publisher("arm_request", robot)
    state: DriverState | None = None
    ends, sent = time.monotonic() + WAIT_S, False
    while time.monotonic() < ends and not (sent and state is not None and _done(state, request)):
        if not sent and state is not None and publisher.matched():
            publisher.publish(request)
            sent, state = True, None
        for sample in inbox.drain():
            if isinstance(sample.message, DriverState):
                state = sample.message
        time.sleep(0.02)
    return state


def _done(state: DriverState, request: ArmRequest) -> bool:
    if request.arm:
        return state.mode == "armed" and state.armed_sender == request.sender
    return state.mode in ("disarmed", "estopped")
