"""Clauses that concern motion: signs, and everything that must end it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tailor.schemas.messages import Odometry
from tailor.tools.conformance.bench import SETTLE_S, Bench, NotPossible
from tailor.tools.conformance.clause import clause

MOVE_S = 1.2
WITHIN = 0.4  # of the commanded speed
LATE_S = 0.2  # beyond a limit in time: a period of the driver's state, and the way over the bus
HOLD_S = 0.5  # silence that releases a dead man's switch


@clause
def moves_as_commanded(bench: Bench) -> Iterator[str]:
    """Each axis moves in the commanded direction at the commanded speed: forward, and left as seen from above."""
    bench.wait(SETTLE_S)
    axes = bench.tested_axes()
    bench.arm()
    for index, _ in axes:
        name, limit = bench.domain.axes[index].name, bench.spec.limits[index]
        for wanted in (bench.fraction * end for end in (limit.upper, limit.lower) if end):
            since_s = bench.link.now_s()
            bench.drive([wanted if each == index else rest for each, rest in enumerate(bench.rest)], MOVE_S)
            found = bench.measured(name, 0.3) or 0.0
            if abs(found - wanted) > WITHIN * abs(wanted):
                yield f"{name}: commanded {wanted:.3g}, measured {found:.3g}"
            yield from _displaced(bench, name, wanted, since_s)
            bench.drive(bench.rest, MOVE_S)


def _displaced(bench: Bench, axis: str, wanted: float, since_s: float) -> Iterator[str]:
    """Whether the pose of the odometry changed in the direction of motion."""
    poses = [each.message for each in bench.heard("odom", since_s) if isinstance(each.message, Odometry)]
    if len(poses) < 2 or axis not in ("v", "omega"):
        return
    first, last = poses[0], poses[-1]
    along = (last.x - first.x) * math.cos(first.phi) + (last.y - first.y) * math.sin(first.phi)
    change = along if axis == "v" else math.remainder(last.phi - first.phi, math.tau)
    if change * wanted <= 0.0:
        what = "along its x axis" if axis == "v" else "in phi"
        yield f"{axis}: commanded {wanted:.3g}, but the pose of odom changed by {change:.3g} {what}"


@clause
def stops_without_commands(bench: Bench) -> Iterator[str]:
    """Without a command for the declared timeout the driver stops the robot by itself, and publishes that."""
    bench.arm_in_motion()
    since_s = bench.link.now_s()
    timeout_s = bench.spec.timeout_ns * 1e-9
    bench.wait(timeout_s + LATE_S)
    stops = [each for each in bench.heard("driver", since_s) if getattr(each.message, "mode", "") != "armed"]
    if not stops:
        yield f"still armed {timeout_s + LATE_S:.1f} s after the last command, expected a stop after {timeout_s:g} s"
    yield from _comes_to_rest(bench)


@clause
def stays_stopped(bench: Bench) -> Iterator[str]:
    """A driver that has stopped ignores commands until somebody arms it again."""
    command = bench.arm_in_motion()
    bench.wait(bench.spec.timeout_ns * 1e-9 + SETTLE_S)
    if bench.state().mode == "armed":
        raise NotPossible("it does not stop without commands")
    bench.await_rest()
    yield from _ignores(bench, command, "it was stopped")


@clause
def takes_no_command_while_disarmed(bench: Bench) -> Iterator[str]:
    """A disarmed driver ignores commands."""
    bench.wait(SETTLE_S)
    yield from _ignores(bench, bench.moving(), "it is disarmed")


@clause
def stops_at_an_estop(bench: Bench) -> Iterator[str]:
    """An e-stop stops the robot at once, and the driver is estopped."""
    command = bench.arm_in_motion()
    bench.estop()
    bench.drive(command, LATE_S + 0.1)
    mode = bench.state().mode
    if mode != "estopped":
        yield f"it is {mode} after an e-stop, expected estopped"
    bench.drive(command, SETTLE_S)
    yield from _comes_to_rest(bench)


@clause
def keeps_an_estop_until_a_reset(bench: Bench) -> Iterator[str]:
    """An e-stop is latched: arming needs a reset."""
    bench.arm()
    bench.estop()
    if bench.settled_state().mode != "estopped":
        raise NotPossible("it does not stop at an e-stop")
    bench.request()
    if bench.settled_state().mode != "estopped":
        yield "a request to arm without reset released the e-stop"
        return
    bench.request(reset=True)
    bench.drive(bench.rest, SETTLE_S)
    if bench.state().mode != "armed":
        yield "a request to arm with reset did not release the e-stop"


@clause
def stops_when_a_held_switch_is_released(bench: Bench) -> Iterator[str]:
    """Silence of a dead man's switch for half a second is an e-stop."""
    bench.arm()
    for _ in range(4):
        bench.estop(False)
        bench.drive(bench.rest, 0.1)
    if bench.state().mode != "armed":
        yield f"it is {bench.state().mode} while the switch is held, expected armed"
    bench.drive(bench.rest, HOLD_S + LATE_S)
    if bench.state().mode != "estopped":
        yield f"it is {bench.state().mode} after the switch was released, expected estopped"


def _comes_to_rest(bench: Bench) -> Iterator[str]:
    bench.wait(MOVE_S)
    if bench.is_moving():
        yield f"the robot still moves {MOVE_S:g} s later"


def _ignores(bench: Bench, command: tuple[float, ...], why: str) -> Iterator[str]:
    accepted, moved = bench.state().accepted, False
    for _ in range(10):
        bench.drive(command, 0.1)
        moved = moved or bench.is_moving()
    state = bench.settled_state()
    if state.mode == "armed":
        yield f"a command armed it, although {why}"
    if moved or state.accepted > accepted:
        yield f"it takes commands although {why}"
