"""One request to arm or disarm a driver: when it is repeated, and what counts as its confirmation. Pure.

A request may be lost, so it is repeated until the driver's state confirms it. A request to disarm is repeated whatever
happens. A request to arm could undo what another person does meanwhile, e.g. release a fresh e-stop with its reset: it
is repeated only while the driver is heard, is the same start, and its state is the one that was seen before the first
request; and never after an e-stop was heard on the bus. What remains is the time that a request is under way.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import StrEnum
from itertools import groupby

from tailor.schemas.messages import ArmRequest, DriverState
from tailor.simnodes.driver import ARM_REFUSED

REPEAT_S = 0.1
FRESH_S = 0.3  # age of the newest state up to which a request to arm is repeated
SETTLE_S = 0.3  # after a refusal or a change: another request may still be under way
IN_A_ROW = 3  # states of one start before a request to arm; of two drivers at 10 Hz each come two at most
WAIT_S = 5.0  # for the driver's first state, and for the confirmation


class Outcome(StrEnum):
    """Outcome of a request to arm or disarm."""

    CONFIRMED = "confirmed"
    REFUSED = "refused"  # detail: the driver's reason
    CHANGED = "changed meanwhile"
    NO_CONFIRMATION = "no confirmation"
    NOT_SENT = "not sent"
    NO_DRIVER = "no driver"
    SEVERAL_DRIVERS = "several drivers"


class Exchange:
    """A request and the driver's states; times are monotonic seconds.

    Attributes:
      state: The newest state of the driver, if any was heard.
      refusal: The driver's reason for refusing the request; empty if it was not refused.
      matched: Set by the caller: somebody has subscribed to the request's topic.
    """

    def __init__(self, request: ArmRequest, now_s: float) -> None:
        """`request`: with epoch 0; a request to arm is sent for the start of the driver that is heard before it."""
        self.state: DriverState | None = None
        self.refusal = ""
        self.matched = False
        self._request = request
        self._before: DriverState | None = None  # newest state before the first request
        self._epochs: list[int] = []  # of the states before the first request
        self._starts: dict[int, tuple[float, DriverState, float]] = {}  # first heard, newest state and its time
        self._heard = 0  # states since the first request
        self._heard_s = now_s
        self._first_s: float | None = None  # of the first request
        self._sent_s = -math.inf  # of the last one
        self._deadline_s = now_s + WAIT_S
        self._halted_s: float | None = None  # since then a request to arm is not repeated

    def hear(self, state: DriverState, at_s: float) -> None:
        """Take a state of the driver that arrived at `at_s`."""
        self.state, self._heard_s = state, at_s
        first_s, *_ = self._starts.get(state.epoch, (at_s,))
        self._starts[state.epoch] = first_s, state, at_s
        before = self._first_s is None or at_s <= self._first_s
        if self._before is None or self._first_s is None:
            self._before = state if before else self._before
            self._epochs.append(state.epoch)
        elif self._request.arm:
            self.refusal = self.refusal or _refused(self._before, state)
            if self.refusal or _situation(state) != _situation(self._before):
                self.halt(at_s)
        self._heard += not before

    @property
    def reported(self) -> DriverState | None:
        """The newest state for people; of several drivers that are to be disarmed, that of one which is not."""
        if self._request.arm:
            return self.state
        begun_s = max((first_s for first_s, *_ in self._starts.values()), default=0.0)
        live = (state for _, state, at_s in self._starts.values() if at_s >= begun_s)  # others have started anew
        return next((state for state in live if not self._is_wanted(state)), self.state)

    def halt(self, now_s: float) -> None:
        """Repeat a request to arm no more, e.g. since an e-stop was heard."""
        self._halted_s = now_s if self._halted_s is None else self._halted_s

    def due(self, now_s: float) -> ArmRequest | None:
        """The request if it is to be published now."""
        if now_s - self._sent_s < REPEAT_S:
            return None
        request = self._request
        if request.arm:
            if self._before is None or self._halted_s is not None or now_s - self._heard_s > FRESH_S:
                return None
            if self._epochs[-IN_A_ROW:] != [self._before.epoch] * IN_A_ROW:
                return None
            request = replace(request, epoch=self._before.epoch)
        if self._first_s is None:
            self._first_s, self._deadline_s = now_s, now_s + WAIT_S
        self._sent_s = now_s
        return request

    def withdrawal(self) -> ArmRequest | None:
        """The request that takes back one to arm which was sent; to be published if nothing confirmed it.

        A driver that stood still, or was out of reach, would else obey it whenever it goes on, and move a robot that
        people believe to be disarmed. It takes requests in their order, so it arms nothing then.
        """
        if not self._request.arm or self._first_s is None or self._before is None:
            return None
        return ArmRequest(arm=False, reset=False, sender="", epoch=self._before.epoch)

    def outcome(self, now_s: float) -> Outcome | None:
        """The outcome as soon as there is one."""
        if self._confirmed():
            return Outcome.CONFIRMED
        if self._request.arm and self._halted_s is not None and now_s - self._halted_s > SETTLE_S:
            return Outcome.REFUSED if self.refusal else Outcome.CHANGED
        if self._request.arm and self._several():
            return Outcome.SEVERAL_DRIVERS
        if now_s < self._deadline_s:
            return None
        if self._first_s is None:
            return Outcome.NO_DRIVER
        return Outcome.NO_CONFIRMATION if self.matched else Outcome.NOT_SENT

    def _confirmed(self) -> bool:
        """Whether the state is as requested, and newer than the request.

        The first state after the request may have been under way before it. Then it shows what was there before.
        """
        if self.state is None or self._heard == 0 or not self._is_wanted(self.reported):
            return False
        before = self._before
        changed = before is not None and before.epoch == self.state.epoch and not self._is_wanted(before)
        return self._heard > 1 or changed

    def _several(self) -> bool:
        """Whether a start was heard again after another one: a driver that starts anew is not."""
        starts = [epoch for epoch, _ in groupby(self._epochs)]
        return len(starts) > len(set(starts))

    def _is_wanted(self, state: DriverState | None) -> bool:
        if state is None:
            return False
        if not self._request.arm:
            return state.mode in ("disarmed", "estopped")
        same_start = self._before is None or state.epoch == self._before.epoch
        return same_start and state.mode == "armed" and state.armed_sender == self._request.sender


def _situation(state: DriverState) -> tuple[object, ...]:
    return state.epoch, state.mode, state.reason, state.detail, state.armed_sender


def _refused(before: DriverState, now: DriverState) -> str:
    """The reason for which the driver has refused more requests to arm than before."""
    counts = dict(zip(before.refused_reasons, before.refused_counts, strict=False))
    for reason, count in zip(now.refused_reasons, now.refused_counts, strict=False):
        if now.epoch == before.epoch and reason.startswith(ARM_REFUSED) and count > counts.get(reason, 0):
            return reason.removeprefix(ARM_REFUSED)
    return ""
