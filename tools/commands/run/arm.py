"""Arm a driver: it obeys the commands of one sender, by default of the one running executive.

The request is repeated until the driver's state confirms it. A request to arm is not repeated once anything else has
changed, such as an e-stop that somebody pressed meanwhile. A robot whose goal is still open moves at once;
`tailor goal --cancel` drops it.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import time

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.stopping import Stop, stoppable
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ArmRequest, DriverState, EStop, ExecStatus
from tailor.schemas.reason_text import reason_text
from tailor.simnodes.reasons import ArmRefusal, Mode
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.systems.endpoint import checked_sender, configure_bus, key_advice, open_bus
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.launch.arming_advice import arming_advice
from tailor.tools.operator.arming_exchange import WAIT_S, Exchange, Outcome
from tailor.tools.operator.stop_button import HEAR_S, driver_states

POLL_S = 0.01
OTHERS_S = 0.35  # after the first executive is heard: every other one publishes its status within 0.1 s
MAX_NAMED = 4
NO_EXECUTIVE = "no executive is heard: none is running, or it stands still; expected one, or --sender"
TEXTS = {
    Outcome.CONFIRMED: "{state}",
    Outcome.REFUSED: "refused: {refusal}; {state}{advice}",
    Outcome.CHANGED: "changed meanwhile, so the request was not repeated; {state}",
    Outcome.NO_CONFIRMATION: "sent, but not confirmed{withdrawn}; {state}",
    Outcome.NOT_SENT: "not sent, since nobody takes requests for {robot}; {state}",
    Outcome.NO_DRIVER: "not sent; {state}",
    Outcome.SEVERAL_DRIVERS: "not sent, since several drivers of {robot} are on the bus, expected one",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor arm`."""
    parser.add_argument("robot", help="robot of the driver, e.g. agilo")
    parser.add_argument("--off", action="store_true", help="disarm instead")
    parser.add_argument("--reset", action="store_true", help="also release a latched emergency stop")
    parser.add_argument(
        "--sender", metavar="HEX", help="sender to obey, 32 hex digits (default: the one running executive)"
    )
    parser.add_argument("--json", action="store_true", help="print outcome, mode and reason as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if the driver's state confirms the request, 1 if not, 2 if it is not clear which executive is meant.

    A signal that ends it before takes a request to arm back first.
    """
    robot: str = arguments.robot
    if not re.fullmatch(r"[\w-]+(/[\w-]+)*", robot, re.ASCII):
        raise UsageError(f"robot {robot!r}: expected a name, e.g. agilo")
    checked_sender(arguments.sender, "--sender")
    if arguments.off and arguments.reset:
        raise UsageError("--off disarms, which releases no emergency stop: expected it without --reset")
    with open_bus(arguments, "people") as session:
        sender = arguments.sender or ("" if arguments.off else _executive_sender(session))
        if not sender and not arguments.off:
            _print(arguments, robot, "no executive", NO_EXECUTIVE, None)
            return 1
        request = ArmRequest(not arguments.off, arguments.reset, sender, 0)
        with stoppable() as stop:
            outcome, exchange = _exchange(session, robot, request, stop)
        if outcome is None:
            return stop.exit_code
        others = "" if exchange.state is not None else _others(session)
        others += "" if session.connected else "; the bus was lost"
    state = _text(robot, exchange.reported) + others
    withdrawn = "" if arguments.off else ", so it was taken back"
    advice = _advice(robot, exchange.refusal)
    text = TEXTS[outcome].format(state=state, refusal=exchange.refusal, robot=robot, withdrawn=withdrawn, advice=advice)
    _print(arguments, robot, outcome.name.lower().replace("_", " "), text, exchange.reported)
    if outcome in (Outcome.NO_CONFIRMATION, Outcome.NOT_SENT) and (hint := key_advice(arguments, "arms drivers")):
        print(hint, file=sys.stderr)
    return 0 if outcome is Outcome.CONFIRMED else 1


def _print(arguments: argparse.Namespace, robot: str, outcome: str, text: str, state: DriverState | None) -> None:
    if not arguments.json:
        print(plain(text))
        return
    driver = {} if state is None else {"mode": state.mode, "reason": state.reason, "detail": state.detail}
    print(json.dumps({"robot": robot, "outcome": outcome, "driver": driver, "text": text}))


def _executive_sender(session: Session) -> str:
    """Sender id of the executive that publishes its status; empty if none does in time.

    Raises:
      UsageError: Several do, of which nobody knows whose commands would move the robot.
    """
    inbox = session.inbox(["status"], "")
    scenarios: dict[str, str] = {}  # by sender
    ends = time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        for sample in inbox.drain():
            if isinstance(sample.message, ExecStatus):
                ends = ends if scenarios else time.monotonic() + OTHERS_S
                scenarios[sample.sender] = sample.message.scenario
        time.sleep(POLL_S)
    if len(scenarios) > 1:
        named = abbreviated([f"{sender} ({scenario})" for sender, scenario in sorted(scenarios.items())], MAX_NAMED)
        raise UsageError(plain(f"{len(scenarios)} executives are running, expected one or --sender: {named}"))
    return next(iter(scenarios), "")


def _exchange(session: Session, robot: str, request: ArmRequest, stop: Stop) -> tuple[Outcome | None, Exchange]:
    """Repeat a request until its outcome is known, or a stop is requested; one to arm without any is taken back."""
    encode(request)  # loads the codec, which takes seconds on a busy machine: no time limit counts them
    publisher, exchange = session.publisher("arm_request", robot), Exchange(request, time.monotonic())
    outcome: Outcome | None = None
    try:
        outcome = _outcome(session, robot, publisher, exchange, stop)
    finally:
        withdrawal = exchange.withdrawal()
        if outcome in (None, Outcome.NO_CONFIRMATION) and withdrawal is not None:
            publisher.publish(withdrawal)
    return outcome, exchange


def _outcome(session: Session, robot: str, publisher: Publisher, exchange: Exchange, stop: Stop) -> Outcome | None:
    inbox = session.inbox(["driver", "estop"], robot, newest_only=False)  # a change in between must be seen
    while not stop.requested:
        for sample in inbox.drain():
            if isinstance(sample.message, DriverState):
                exchange.hear(sample.message, sample.arrival_ns / 1e9)
            elif isinstance(sample.message, EStop) and sample.message.stop:
                exchange.halt(time.monotonic())
        outcome = exchange.outcome(time.monotonic())  # of all that has arrived, however late this process gets the CPU
        if outcome is not None:
            return outcome
        due = exchange.due(time.monotonic())
        if due is not None:
            publisher.publish(due)
        exchange.matched = exchange.matched or publisher.matched()
        time.sleep(POLL_S)
    return None


def _advice(robot: str, refusal: str) -> str:
    """The command that removes the cause of a refusal, where there is one."""
    if refusal == ArmRefusal.ESTOP_LATCHED:
        return f" ({arming_advice(robot, Mode.ESTOPPED)})"
    return f" (`tailor arm {robot} --off` disarms it)" if refusal == ArmRefusal.OTHER_SENDER_ARMED else ""


def _others(session: Session) -> str:
    """Whose drivers are heard, since the robot that was named has none: its name may be misspelt."""
    with driver_states(session) as states:
        time.sleep(HEAR_S)
        states.poll()
    return f"; drivers are heard of: {', '.join(sorted(states.newest)[:MAX_NAMED]) or 'none'}"


def _text(robot: str, state: DriverState | None) -> str:
    if state is None:
        return f"the driver of {robot} does not respond"
    cause = reason_text(state.reason, state.detail)
    return f"{robot} is {state.mode}" + (f": {cause}" if cause else "")
