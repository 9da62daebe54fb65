"""Clauses that concern arming, and commands that an armed driver must refuse."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from tailor.schemas.messages import DriverState
from tailor.simnodes.guard import Limit
from tailor.tools.conformance.bench import SETTLE_S, Bench
from tailor.tools.conformance.clause import clause

COUNT = 8  # wrong commands
SLACK = 3  # valid commands that may not show in the driver's state yet


@clause
def arms_for_one_sender(bench: Bench) -> Iterator[str]:
    """People arm the driver for one sender; for another one only after it was disarmed."""
    bench.request()
    bench.drive(bench.rest, SETTLE_S)
    state = bench.state()
    if state.mode != "armed" or state.armed_sender != bench.sender:
        yield f"requested to arm for {bench.sender}: it is {state.mode} for '{state.armed_sender}', {state.detail}"
        return
    bench.request(sender=bench.other)
    bench.drive(bench.rest, SETTLE_S)
    if bench.state().armed_sender != bench.sender:
        yield "a second sender took over while the first one was armed"
    bench.request(arm=False)
    if bench.settled_state().mode != "disarmed":
        yield f"requested to disarm: it is {bench.state().mode}"


@clause
def refuses_another_epoch(bench: Bench) -> Iterator[str]:
    """A request to arm for another start of the driver is refused."""
    bench.request(epoch=bench.state().epoch + 1)
    bench.drive(bench.rest, SETTLE_S)
    if bench.state().mode == "armed":
        yield "a request for another epoch armed it"


@clause
def refuses_other_senders(bench: Bench) -> Iterator[str]:
    """An armed driver takes commands of its sender alone."""
    command = bench.rest
    yield from _refuses(bench, "of another sender", lambda: bench.send(command, sender=bench.other, counts=False))


@clause
def refuses_old_numbers(bench: Bench) -> Iterator[str]:
    """A command whose sequence number does not rise is refused: it was repeated or recorded."""
    yield from _refuses(bench, "with an old number", lambda: bench.send(bench.rest, behind=1, counts=False))


@clause
def refuses_late_commands(bench: Bench) -> Iterator[str]:
    """A command that was under way for too long, by its stamp, is refused."""
    yield from _refuses(bench, "of a second ago", lambda: bench.send(bench.rest, age_s=1.0, counts=False))


@clause
def refuses_numbers_that_are_not_finite(bench: Bench) -> Iterator[str]:
    """A command with NaN or an infinite number is refused."""
    values = [math.nan, *bench.rest[1:]]
    yield from _refuses(bench, "with NaN", lambda: bench.send(values, counts=False))


@clause
def refuses_values_beyond_limits(bench: Bench) -> Iterator[str]:
    """A command beyond the declared limits is refused, not clipped; one on a limit is legal."""
    values = [beyond(bench.spec.limits[0]), *bench.rest[1:]]
    yield from _refuses(bench, "beyond a limit", lambda: bench.send(values, counts=False))


def beyond(limit: Limit) -> float:
    """A value a little above the range of an axis; that of one which keeps its set-point may lie below zero."""
    return limit.upper + 0.01 * abs(limit.upper) + 1e-6


def _refuses(bench: Bench, what: str, wrong: Callable[[], None]) -> Iterator[str]:
    """Wrong commands between valid ones of standstill: none counts as accepted, and the valid ones still count."""
    bench.arm()
    bench.drive(bench.rest, 1.5)  # so that the driver knows how long commands are under way
    before, sent = bench.state(), bench.sent
    for _ in range(COUNT):
        bench.send(bench.rest)
        wrong()
        bench.wait(0.1)
    bench.drive(bench.rest, SETTLE_S)
    after, valid = bench.state(), bench.sent - sent
    taken = after.accepted - before.accepted
    if after.mode != "armed":
        yield f"commands {what} stopped it ({after.reason}): they must change nothing but a count"
    elif taken > valid + SLACK:
        yield f"it took {taken - valid} of {COUNT} commands {what}"
    elif _refused(after) == _refused(before):
        yield f"commands {what} are not counted as refused"


def _refused(state: DriverState) -> int:
    return sum(state.refused_counts)
