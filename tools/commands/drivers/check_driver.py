"""Check a driver on the bus against its contract, clause by clause, then whether the robot moves as its models expect.

The robot moves, slowly, and ALL drivers on the bus are e-stopped three times: twice by an e-stop, once by a dead man's
switch that is let go. Hardware needs a confirmation.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from tailor.executive import domains
from tailor.runtime.bus.session import Session
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.schemas.messages import DriverState
from tailor.tools.cli.output_files import check_output, check_writable, whole_output
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.endpoint import configure_bus, open_bus
from tailor.tools.conformance import report as reports
from tailor.tools.conformance.bench import Bench, EStopPressed, NotPossible
from tailor.tools.conformance.clause import Verdict
from tailor.tools.conformance.fit import Response, differences, responses
from tailor.tools.conformance.live_link import LiveLink, NoDriverError
from tailor.tools.conformance.report import Report
from tailor.tools.conformance.simulated_link import SimulatedLink
from tailor.tools.conformance.stamp_offsets import stamp_offsets
from tailor.tools.conformance.suite import clauses, verdicts
from tailor.tools.launch.checks.driver_check import check_driver, driver_of
from tailor.tools.lockstep.worlds import make_world

MAX_FRACTION = 0.3  # of the limits, for all but the fit at top speed
LISTEN_S = 0.5  # for other drivers, which publish at 10 Hz


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor check-driver`."""
    parser.add_argument("robot", help=f"robot of the driver: {', '.join(robot_names())}")
    parser.add_argument("--driver", metavar="FILE", help="specification of the driver (default: that of its package)")
    parser.add_argument("--report", metavar="FILE", type=Path, help="write the outcome as a Markdown page")
    parser.add_argument("--json", action="store_true", help="print the outcome as JSON")
    parser.add_argument("--speed", type=float, default=0.15, help="test speed as a fraction of the limits (0.15)")
    parser.add_argument("--top-speed", action="store_true", help="compare step responses up to the limits")
    parser.add_argument("--clause", action="append", default=[], help="try only this clause; may be repeated")
    parser.add_argument("--no-fit", action="store_true", help="leave out the comparison with the models' robot")
    parser.add_argument(
        "--yes", action="store_true", help="hardware: people know, and the robot has two metres of room"
    )
    parser.add_argument("--reset", action="store_true", help="release an emergency stop that is latched before")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if every clause was tried and kept and the robot moves as expected, else 1."""
    domain = domains.load(spec_of_robot(arguments.robot).name)
    spec = driver_of(domain, arguments.driver)
    check_driver(domain, spec)
    named = _checked_flags(arguments)
    codec.prime()
    with open_bus(arguments, "executive") as executive, open_bus(arguments, "people") as people:
        sensors = [sensor.topic for sensor in spec.sensors]
        try:
            link = LiveLink(executive, people, arguments.robot, spec.command_topics, sensors)
        except NoDriverError as error:
            raise UsageError(str(error)) from error
        bench = Bench(link, domain, spec, arguments.speed)
        _check_free(bench, arguments.robot, arguments.reset)
        simulated = _is_simulator(people, arguments.robot)
        if not simulated:
            _confirm(arguments.robot, arguments.yes)
        report = _watched(bench, arguments, named, "simulator" if simulated else "hardware")
    if report is None:
        return 1
    if arguments.json:
        print(json.dumps(reports.values(report)))
    if arguments.report is not None:
        with whole_output(arguments.report) as whole:
            whole.write_text(reports.markdown(report), encoding="utf-8")
    return 0 if report.kept and not (report.misfits or report.not_compared) else 1


def _checked_flags(arguments: argparse.Namespace) -> list[str]:
    """Names of the clauses to try; empty: all. Raises UsageError before the robot moves."""
    if not 0.0 < arguments.speed <= MAX_FRACTION:
        raise UsageError(f"--speed is {arguments.speed:g}, expected more than 0 and at most {MAX_FRACTION:g}")
    known = [each.name for each in clauses()]
    named = [each.replace(" ", "_").replace("-", "_") for each in arguments.clause]
    unknown = sorted(set(named) - set(known))
    if unknown:
        raise UsageError(f"--clause {', '.join(unknown)}: expected one of: {', '.join(known)}")
    if arguments.report is not None:
        check_output("--report", arguments.report, (".md",))
        check_writable("--report", arguments.report)  # not after the robot has moved
    if arguments.no_fit and arguments.top_speed:
        raise UsageError("--top-speed: of the comparison that --no-fit leaves out, expected one of both")
    return named


def _watched(bench: Bench, arguments: argparse.Namespace, named: list[str], kind: str) -> Report | None:
    """As `_checked`, with the driver disarmed at the end; None if somebody pressed the e-stop, which stays latched."""
    try:
        return _checked(bench, arguments, named, kind)
    except EStopPressed as error:
        bench.estop()  # a reset of our own may have come after theirs
        advice = f"it stays latched; `tailor arm {arguments.robot} --reset` releases it, or --reset for another check"
        note(f"tailor check-driver: {error}: the check ends, and {advice}", to_stderr=True)
        return None
    finally:
        bench.request(arm=False)


def _checked(bench: Bench, arguments: argparse.Namespace, named: list[str], kind: str) -> Report:
    """Try everything, and print each outcome as it comes."""

    def show(text: str) -> None:
        if not arguments.json:
            print(text, flush=True)

    found: list[Verdict] = []
    for verdict in verdicts(bench, named):
        found.append(verdict)
        show(reports.line(verdict))
    for remark in (remarks := tuple(stamp_offsets(bench))):
        show(f"note: {remark}")
    robot: str = arguments.robot
    if arguments.no_fit or not spec_of_robot(robot).body:
        return Report(robot, kind, found, remarks=remarks)
    try:
        real, models = _fit(bench, 1.0 if arguments.top_speed else arguments.speed)
    except NotPossible as error:
        show(f"fit: not tried: {error}")
        return Report(robot, kind, found, not_compared=str(error), remarks=remarks)
    report = Report(robot, kind, found, real, models, list(differences(real, models)), remarks=remarks)
    for misfit in report.misfits or ["it moves as the models' robot does"]:
        show(f"fit: {misfit}")
    if report.misfits:
        show(reports.advice(report))
    return report


def _fit(bench: Bench, fraction: float) -> tuple[list[Response], list[Response]]:
    """Step responses of the driver on the bus, and of the body that the models were learned on."""
    robot = bench.domain.robot
    model = Bench(SimulatedLink(make_world(robot, "", 0), bench.spec), bench.domain, bench.spec, bench.fraction)
    return responses(bench, fraction), responses(model, fraction)


def _is_simulator(people: Session, robot: str) -> bool:
    """Whether a simulator refuses a step of none; whatever else answers, or does not in time, may be hardware."""
    _, answer = people.call(f"{robot}/sim/step", "0", timeout_s=1.0)
    return answer.startswith("step: ")


def _confirm(robot: str, agreed: bool) -> None:
    """Let a person confirm that hardware may move.

    Raises:
      UsageError: Nobody does.
    """
    if agreed:
        return
    if sys.stdin is None or not sys.stdin.isatty():
        raise UsageError(f"{robot} is hardware that will move, expected --yes or a terminal to confirm")
    print(
        f"{robot} is no simulator. It will move slowly, half a metre to all sides, and all drivers are e-stopped three "
        "times. An e-stop that is pressed meanwhile ends the check."
    )
    try:
        typed = input(f"People stand clear, the hardware e-stop is at hand? Type {robot} to go on: ")
    except EOFError:  # Ctrl-D
        typed = ""
    if typed.strip() != robot:
        raise UsageError("not confirmed, so nothing was moved")


def _check_free(bench: Bench, robot: str, may_release: bool) -> None:
    """Raise UsageError unless one driver is heard, and nobody uses or stopped it.

    A forgotten simulator beside hardware would pass for the only driver, and the hardware would move unasked.
    """
    try:
        bench.wait(LISTEN_S)
        state = bench.state()
    except (NotPossible, EStopPressed) as error:
        raise UsageError(f"{robot}: {error}") from error
    if len({each.message.epoch for each in bench.heard("driver") if isinstance(each.message, DriverState)}) > 1:
        raise UsageError(f"several drivers of {robot} are on the bus, or one has just started anew; expected one")
    if state.mode == "armed":
        raise UsageError(f"{robot} is armed for {state.armed_sender}, expected a driver that nobody uses")
    if state.mode == "estopped" and not may_release:
        raise UsageError(f"{robot} is e-stopped ({state.detail or state.reason}), expected --reset to release that")
