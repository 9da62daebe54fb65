"""Consequences of a fault are timed from it; those of what people do later are not taken for them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tailor.tools.soak.faults.scene import FaultRecord
from tailor.tools.soak.judging.violations import Invariant
from tailor.tools.soak.tracking import follow

S = 1_000_000_000


class Followed:
    """A record of a fault at 10 s, of a system of plain values."""

    def __init__(self):
        self.record = FaultRecord("executive killed", 1, "agilo", 10.0, 10 * S, moving=True)
        self.judge = SimpleNamespace(revoked_ns=0, zero_ns=None, rest_ns=None, moved_ns=9 * S)
        self.people = SimpleNamespace(prepared_ns=0, armed_ns=0, armed_for_task=True)
        self.complete, self.heard = True, True
        self.reported = []

    def follow(self, at_s):
        system = SimpleNamespace(judge=self.judge, heard=lambda now_ns: self.heard, complete=lambda: self.complete)
        follow(self.record, system, self.people, round(at_s * S), lambda *row: self.reported.append(row[1:]))

    def stop(self):
        self.judge.revoked_ns, self.judge.zero_ns, self.judge.rest_ns = 10 * S, round(10.25 * S), round(11.5 * S)


@pytest.fixture
def followed():
    return Followed()


def test_stop_and_rest_are_timed_from_the_fault(followed):
    followed.stop()
    followed.follow(12)
    assert (followed.record.zero_s, followed.record.rest_s) == (0.25, 1.5)


def test_a_stop_before_the_fault_is_not_its_own(followed):
    followed.judge.revoked_ns, followed.judge.zero_ns = 8 * S, 9 * S
    followed.follow(12)
    assert followed.record.zero_s is None


def test_a_stop_that_people_cause_later_is_not_its_own(followed):
    followed.people.prepared_ns = 11 * S
    followed.judge.revoked_ns = followed.judge.zero_ns = 11 * S
    followed.follow(12)
    assert followed.record.zero_s is None


def test_a_body_that_ended_does_not_come_to_rest(followed):
    followed.stop()
    followed.record.body_ends = True
    followed.follow(12)
    assert followed.record.zero_s is None


def test_motion_is_timed_from_peoples_arming(followed):
    followed.people.armed_ns, followed.judge.moved_ns = 13 * S, round(13.4 * S)
    followed.follow(14)
    assert followed.record.again_s == pytest.approx(0.4)


@pytest.mark.parametrize("lacking", ["complete", "heard", "successor"])
def test_a_recovery_needs_all_children_and_a_successor_that_is_heard(followed, lacking):
    followed.record.back_when, followed.record.back_limit_s = (lambda: lacking != "successor"), 5.0
    if lacking != "successor":
        setattr(followed, lacking, False)
    followed.follow(14.9)
    assert (followed.record.back_s, followed.reported) == (None, [])
    followed.follow(15.1)
    followed.follow(16.0)
    assert followed.reported == [(Invariant.BACK_IN_TIME, "not back after 5.1 s")]


def test_a_recovery_in_time_is_timed(followed):
    followed.record.back_when, followed.record.back_limit_s = (lambda: True), 5.0
    followed.follow(12.5)
    followed.follow(13.0)
    assert (followed.record.back_s, followed.reported) == (2.5, [])
