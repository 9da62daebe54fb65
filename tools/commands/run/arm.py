"""Let a driver obey a sender of commands: the running executive unless another one is named."""

from __future__ import annotations

import argparse
import re
import time

from tailor.runtime.bus.session import Session, open_client
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ArmRequest, DriverState, ExecStatus
from tailor.tools.cli.endpoint import configure_bus, endpoint_of

WAIT_S = 2.0  # for the executive to show itself, and for the driver's answer


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor arm`."""
    parser.add_argument("robot", nargs="?", default="agilo", help="whose driver (default agilo)")
    parser.add_argument("--off", action="store_true", help="disarm instead")
    parser.add_argument("--reset", action="store_true", help="also leave a latched e-stop")
    parser.add_argument("--sender", metavar="HEX", help="32 hex digits (default: the running executive)")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 when the driver has done it, 1 when it has not."""
    if not re.fullmatch(r"[\w-]+(/[\w-]+)*", arguments.robot, re.ASCII):
        raise UsageError(f"robot {arguments.robot!r}: expected a name, e.g. agilo")
    if arguments.sender and not re.fullmatch("[0-9a-f]{32}", arguments.sender):
        raise UsageError(f"--sender {arguments.sender}: expected 32 hex digits")
    with open_client(endpoint_of(arguments)) as session:
        sender = arguments.sender or ("" if arguments.off else _executive(session))
        if not sender and not arguments.off:
            print("no executive is running, and no --sender was named")
            return 1
        request = ArmRequest(not arguments.off, arguments.reset, sender, 0)
        state = _ask(session, arguments.robot, request)
    if state is None:
        print(f"no driver of {arguments.robot} answers")
        return 1
    print(f"{arguments.robot} is {state.mode}" + (f": {state.reason}" if state.reason else ""))
    return 0 if _done(state, request) else 1


def _executive(session: Session) -> str:
    """The sender id of the executive that shows itself on the bus, empty if none does in time."""
    inbox = session.inbox(["status"], "")
    ends = time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        for sample in inbox.drain():
            if isinstance(sample.message, ExecStatus):
                return sample.sender
        time.sleep(0.02)
    return ""


def _ask(session: Session, robot: str, request: ArmRequest) -> DriverState | None:
    """Send a request and wait until the driver's state shows it, or time is up; the last state seen."""
    inbox, outlet = session.inbox(["driver"], robot), session.publisher("arm_request", robot)
    state: DriverState | None = None
    ends, sent = time.monotonic() + WAIT_S, False
    while time.monotonic() < ends and not (sent and state is not None and _done(state, request)):
        if not sent and state is not None and outlet.matched():
            outlet.publish(request)
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
