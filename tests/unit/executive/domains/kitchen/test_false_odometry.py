"""A base whose odometry reports that it stands while it drives: the executive holds, and tells why."""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.interfaces.reasons import Reason
from tests.unit.executive.domains.kitchen.test_blind import driven


def standing(sample):
    return dataclasses.replace(sample, message=dataclasses.replace(sample.message, v=0.0, omega=0.0))


@pytest.mark.promise("P6")
def test_it_stands_within_two_seconds_and_goes_on_once_odometry_is_true():
    states = driven(standing, key="b21/odom", ticks=75, first=20)  # it drives then, and does not brake yet
    held = [state for state in states if state.mode is Mode.HOLDING and state.tick > 20]
    assert 20 < held[0].tick <= 40
    assert {s.cause.reason for s in held} == {Reason.INPUT_STALE}
    assert all(s.cause.detail.startswith("odom has v at 0") for s in held)
    assert all(state.command[:8] == (0.0,) * 8 for state in held)
    assert states[-1].mode is Mode.EXECUTING
