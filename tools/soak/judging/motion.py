"""Judges the motion of one robot: who gave leave to move, what revoked it, was the robot at rest in time. Pure."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from tailor.tools.soak.judging.robots import AT_REST, BODY_TOLERANCE, Robot, is_moving
from tailor.tools.soak.judging.violations import Invariant

START_NS = 60_000_000_000  # from the launcher's start to the first arming
ARMING_NS = 2_000_000_000  # from people's request to the arming
MARGIN_NS = 50_000_000  # of the measurement: one period of the guard, and the way to this process
REST_NS = 300_000_000  # beyond the deceleration time
UNASKED_NS = 1_000_000_000  # motion so long after it was due to end is not a late stop but motion
RECENT_NS = 300_000_000  # a body's speed when its guard stops it
NEVER_NS = 1 << 62

Report = Callable[[int, Invariant, str], None]  # time, invariant, detail


class MotionJudge:
    """Leave to move, as this program alone knows it; the driver's reports only take it away.

    Attributes:
      permitted: Whether the robot may move.
      revoked_ns: Time of the last revocation.
      zero_ns: Time at which the driver reported its stop after that; None: not yet.
      rest_ns: Time at which the body was at rest after that; None: not yet.
      moved_ns: Time of the last motion.
      stops: Stops of the driver that nobody here caused.
    """

    def __init__(self, robot: Robot, report: Report) -> None:
        """No leave yet; `report` receives each violation once for each revocation."""
        self.permitted = False
        self.revoked_ns = 0
        self.zero_ns: int | None = None
        self.rest_ns: int | None = None
        self.moved_ns = 0
        self.stops = 0
        self._robot, self._report = robot, report
        self._armed = False  # since the leave was given
        self._until_ns = 0  # the arming is due
        self._zero_due_ns = self._rest_due_ns = NEVER_NS
        self._armed_until_ns = 0  # without leave: reports from before the stop may still arrive
        self._epoch = 0
        self._recent: deque[tuple[int, tuple[float, ...]]] = deque(maxlen=8)
        self._reported: set[Invariant] = set()

    def launched(self, now_ns: int) -> None:
        """The launcher starts: it gives its executive leave to arm once."""
        self._permit(now_ns + START_NS)
        self._epoch = 0

    def people_arm(self, now_ns: int) -> None:
        """People request the arming."""
        self._permit(now_ns + ARMING_NS)

    def revoke(self, now_ns: int, zero_within_s: float | None = None) -> None:
        """Something ends the leave, e.g. an e-stop, or the end of the executive.

        Args:
          now_ns: Monotonic time.
          zero_within_s: The driver reports its stop by then; None: it cannot, since it has ended.
        """
        was_armed = self._armed
        self.permitted = self._armed = False
        self.revoked_ns, self.zero_ns, self.rest_ns = now_ns, None, None
        self._rest_due_ns = NEVER_NS
        due = was_armed and zero_within_s is not None
        self._zero_due_ns = now_ns + round((zero_within_s or 0.0) * 1e9) + MARGIN_NS if due else NEVER_NS
        self._armed_until_ns = (self._zero_due_ns if due else now_ns) + UNASKED_NS
        self._reported.clear()

    def driver(self, now_ns: int, mode: str, epoch: int) -> None:
        """The driver's own report."""
        if epoch != self._epoch:
            restarted, self._epoch = self._epoch != 0, epoch
            if restarted:
                self.revoke(now_ns)
                self._armed_until_ns = 0  # a new driver has no past
        if mode == "armed":
            self._driver_is_armed(now_ns)
        elif self.permitted and (self._armed or now_ns > self._until_ns):
            self.stops += self._armed and mode == "stopped"
            self.revoke(now_ns)
            self._stopped(now_ns)
        elif not self.permitted and self.zero_ns is None:
            self._stopped(now_ns)

    def truth(self, now_ns: int, speeds: tuple[float, ...], at_rest: float = AT_REST) -> None:
        """The body's speeds, from the simulator; below `at_rest` it does not move by itself."""
        self._recent.append((now_ns, speeds))
        if is_moving(speeds):
            self.moved_ns = now_ns
        if not self._robot.within_limits(speeds, BODY_TOLERANCE):
            self._violated(now_ns, Invariant.OUTPUT_LIMITS, f"the body moves at {_text(speeds)}")
        if self.permitted:
            return
        if not is_moving(speeds, at_rest):
            self.rest_ns = self.rest_ns or now_ns
        elif now_ns > self._rest_due_ns + UNASKED_NS:
            after_s = (now_ns - self.revoked_ns) / 1e9
            self._violated(now_ns, Invariant.UNASKED_MOTION, f"{_text(speeds)}, {after_s:.2f} s after its leave ended")
        elif now_ns > self._rest_due_ns:
            late_s = (now_ns - self._rest_due_ns) / 1e9
            self._violated(now_ns, Invariant.REST_IN_TIME, f"still {_text(speeds)}, {late_s:.2f} s late")

    def command(self, now_ns: int, values: tuple[float, ...]) -> None:
        """A command of the executive."""
        if len(values) != len(self._robot.limits) or not self._robot.within_limits(values):
            self._violated(now_ns, Invariant.OUTPUT_LIMITS, f"the executive commands {_text(values)}")

    def check(self, now_ns: int) -> None:
        """Report a stop that is overdue; call it a few times a second."""
        if not self.permitted and self.zero_ns is None and now_ns > self._zero_due_ns + MARGIN_NS:
            late_s = (now_ns - self.revoked_ns) / 1e9
            self._violated(now_ns, Invariant.ZERO_IN_TIME, f"no stop of the driver {late_s:.2f} s after its cause")

    def at_rest_since(self, now_ns: int, duration_ns: int) -> bool:
        """Whether nothing moved for so long, and the leave ended at least as long ago."""
        return now_ns - max(self.revoked_ns, self.moved_ns) > duration_ns

    def _permit(self, until_ns: int) -> None:
        self.permitted, self._armed, self._until_ns = True, False, until_ns
        self._zero_due_ns = self._rest_due_ns = NEVER_NS
        self._reported.clear()

    def _driver_is_armed(self, now_ns: int) -> None:
        if self.permitted:
            self._armed = True
        elif self.zero_ns is not None or now_ns > self._armed_until_ns:
            after_s = (now_ns - self.revoked_ns) / 1e9
            self._violated(now_ns, Invariant.UNASKED_ARMING, f"armed {after_s:.2f} s after its leave ended")

    def _stopped(self, now_ns: int) -> None:
        """The guard's output is zero from now on."""
        self.zero_ns = now_ns
        if now_ns > self._zero_due_ns:
            took_s = (now_ns - self.revoked_ns) / 1e9
            self._violated(now_ns, Invariant.ZERO_IN_TIME, f"zero {took_s:.3f} s after its cause")
        fastest_s = [self._robot.rest_s(speeds) for at_ns, speeds in self._recent if at_ns > now_ns - RECENT_NS]
        self._rest_due_ns = now_ns + round(max(fastest_s, default=0.0) * 1e9) + REST_NS

    def _violated(self, now_ns: int, invariant: Invariant, detail: str) -> None:
        if invariant not in self._reported:
            self._reported.add(invariant)
            self._report(now_ns, invariant, detail)


def _text(values: tuple[float, ...]) -> str:
    return ", ".join(f"{value:.3f}" for value in values)
