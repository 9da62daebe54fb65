"""Follows the consequences of a fault: stop, rest, recovery, motion after people's arming."""

from __future__ import annotations

from tailor.tools.soak.faults.scene import FaultRecord
from tailor.tools.soak.judging.motion import Report
from tailor.tools.soak.judging.violations import Invariant
from tailor.tools.soak.systems.people import People
from tailor.tools.soak.systems.system import System


def follow(record: FaultRecord, system: System, people: People, now_ns: int, report: Report) -> None:
    """Take times that have become known; report a recovery that is overdue."""
    if not record.body_ends:
        _follow_stop(record, system, people)
    moved_ns = system.judge.moved_ns
    if record.again_s is None and people.armed_for_task and record.at_ns < people.armed_ns < moved_ns:
        record.again_s = (moved_ns - people.armed_ns) / 1e9
    _follow_recovery(record, system, now_ns, report)


def _follow_stop(record: FaultRecord, system: System, people: People) -> None:
    judge, since = system.judge, record.at_ns
    stopped = judge.zero_ns is not None and min(judge.zero_ns, judge.revoked_ns) >= since > people.prepared_ns
    if record.zero_s is None and judge.zero_ns is not None and stopped:
        record.zero_s = (judge.zero_ns - since) / 1e9
    if record.zero_s is not None and record.rest_s is None and judge.rest_ns is not None and judge.rest_ns >= since:
        record.rest_s = (judge.rest_ns - since) / 1e9


def _follow_recovery(record: FaultRecord, system: System, now_ns: int, report: Report) -> None:
    if record.back_when is None or record.back_s is not None:
        return
    took_s = (now_ns - record.at_ns) / 1e9
    if system.heard(now_ns) and system.complete() and record.back_when():
        record.back_s = took_s
    if took_s > record.back_limit_s and not record.back_late and record.back_s is None:
        record.back_late = True
        report(now_ns, Invariant.BACK_IN_TIME, f"not back after {took_s:.1f} s")
