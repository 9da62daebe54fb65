"""What is repeated and what counts as confirmed when people arm or disarm; times in seconds."""

import re
from types import SimpleNamespace

import pytest

from tailor.schemas.messages import ArmRequest, DriverState, Sample
from tailor.tools.commands.run import arm
from tailor.tools.operator.arming_exchange import Exchange, Outcome
from tests.support.bus_system import ROOT

A, B = "a" * 32, "b" * 32
OFF = ArmRequest(False, False, "", 0)
ARM, RESET = ArmRequest(True, False, A, 0), ArmRequest(True, True, A, 0)


def state(mode="disarmed", epoch=7, sender="", refused=(), **reason):
    fields = {"reason": "", "detail": "", **reason}
    names, counts = zip(*refused, strict=True) if refused else ((), ())
    return DriverState(0, mode, fields["reason"], fields["detail"], epoch, sender, 0, names, counts)


ARMED, ESTOPPED = state("armed", sender=A), state("estopped", reason="e-stop")


def exchange(request, before=None):
    """An exchange that has heard a state up to 0.9 s and has sent its first request at 1 s, if it could."""
    made = Exchange(request, 0.0)
    for at_s in (0.7, 0.8, 0.9) if before is not None else ():
        made.hear(before, at_s)
    made.due(1.0)
    return made


def repeats(made, *times_s):
    return [made.due(at_s) is not None for at_s in times_s]


@pytest.mark.promise("P52")
def test_a_request_to_disarm_is_repeated_from_the_first_moment_until_it_is_confirmed():
    made = Exchange(OFF, 0.0)
    assert repeats(made, 0.0, 0.05, 0.11, 0.15, 0.22) == [True, False, True, False, True]
    made.hear(ARMED, 0.25)
    assert made.outcome(0.25) is None
    assert made.due(0.33) == OFF
    made.hear(state(), 0.35)
    assert made.outcome(0.35) is Outcome.CONFIRMED


def test_the_first_state_of_all_confirms_nothing_since_it_may_be_stale():
    made = exchange(OFF)
    made.hear(state(), 1.05)
    assert made.outcome(1.05) is None
    made.hear(state(), 1.15)
    assert made.outcome(1.15) is Outcome.CONFIRMED


@pytest.mark.promise("P52")
def test_a_state_that_arrived_before_the_request_confirms_nothing():
    made = exchange(OFF, state())
    assert made.outcome(1.0) is None
    made.hear(state(), 1.0)
    assert made.outcome(1.01) is None
    made.hear(state(), 1.05)
    assert made.outcome(1.05) is None, "it may have been under way"
    made.hear(state(), 1.15)
    assert made.outcome(1.15) is Outcome.CONFIRMED


@pytest.mark.parametrize("mode", ["disarmed", "estopped"])
def test_a_change_after_the_request_confirms_at_once(mode):
    made = exchange(OFF, ARMED)
    made.hear(state(mode), 1.02)
    assert made.outcome(1.02) is Outcome.CONFIRMED


def test_a_request_to_arm_waits_for_the_driver_and_means_its_present_start():
    made = Exchange(ARM, 0.0)
    assert made.due(0.0) is None
    made.hear(state(epoch=6), 0.4)
    for at_s in (0.5, 0.6, 0.7):
        assert made.due(at_s) is None, "another driver may be heard next"
        made.hear(state(), at_s)
    assert made.due(0.7) == ArmRequest(True, False, A, 7)
    made.hear(ARMED, 0.72)
    assert made.outcome(0.72) is Outcome.CONFIRMED


@pytest.mark.parametrize("epochs", ["7878", "7887", "7788778", "878", "7987"])
@pytest.mark.promise("P52")
def test_none_of_several_drivers_is_armed(epochs):
    made = Exchange(ARM, 0.0)
    for number, epoch in enumerate(epochs):
        assert made.outcome(0.1 * number) is None
        made.hear(state(epoch=int(epoch)), 0.1 * number)
        assert made.due(0.1 * number) is None
        if made.outcome(0.1 * number) is not None:
            break
    assert made.outcome(0.1 * number) is Outcome.SEVERAL_DRIVERS


@pytest.mark.promise("P52")
def test_several_drivers_are_disarmed_at_once():
    made = Exchange(OFF, 0.0)
    for epoch, at_s in ((7, 0.0), (8, 0.05), (7, 0.1)):
        made.hear(state("armed", epoch=epoch, sender=A), at_s)
    assert made.due(0.1) == OFF
    assert made.outcome(0.1) is None


@pytest.mark.promise("P52")
def test_one_of_several_drivers_that_is_disarmed_confirms_nothing_for_the_others():
    """That of a forgotten simulator did, while the robot's own was armed."""
    made = Exchange(OFF, 0.0)
    assert made.due(0.0) == OFF
    for number in range(20):
        made.hear(state("armed", epoch=8, sender=A) if number % 2 else state(), 0.02 + 0.05 * number)
        assert made.outcome(0.02 + 0.05 * number) is None
    assert made.reported.epoch == 8
    made.hear(state(epoch=8), 1.05)
    assert made.outcome(1.05) is Outcome.CONFIRMED


def test_an_armed_driver_that_has_started_anew_is_disarmed_once_that_start_is_heard():
    made = Exchange(OFF, 0.0)
    made.due(0.0)
    made.hear(ARMED, 0.05)
    assert made.outcome(1.0) is None
    made.hear(state(epoch=8), 1.0)
    assert made.outcome(1.0) is Outcome.CONFIRMED


@pytest.mark.parametrize("other", [state("armed", sender=B), state("armed", epoch=8, sender=A), state("stopped")])
def test_another_state_does_not_confirm_a_request_to_arm(other):
    made = exchange(ARM, state())
    made.hear(other, 1.1)
    made.hear(other, 1.2)
    assert made.outcome(1.3) is None
    assert made.outcome(1.41) is Outcome.CHANGED


def test_a_request_to_arm_is_repeated_while_nothing_changes():
    made = exchange(RESET, ESTOPPED)
    for at_s in (1.11, 1.22, 1.33):
        made.hear(ESTOPPED, at_s - 0.05)
        assert made.due(at_s) == ArmRequest(True, True, A, 7)
        assert made.outcome(at_s) is None


@pytest.mark.parametrize(
    "change",
    [
        state("estopped", reason="the dead man's switch was released"),
        state("estopped", reason="e-stop", detail="held by 11111111"),
        state("estopped", reason="e-stop", epoch=8),
        state("stopped"),
        state("armed", sender=B),
    ],
)
@pytest.mark.promise("P52")
def test_a_request_to_arm_is_never_repeated_after_any_change(change):
    made = exchange(RESET, ESTOPPED)
    made.hear(change, 1.05)
    made.hear(ESTOPPED, 1.15)
    assert repeats(made, 1.2, 1.5, 4.0) == [False, False, False]
    assert made.outcome(1.2) is None, "the first request may still be under way"
    assert made.outcome(1.36) is Outcome.CHANGED


@pytest.mark.promise("P52")
def test_an_estop_that_changes_no_state_ends_the_repetitions_too():
    made = exchange(RESET, ESTOPPED)
    made.halt(1.02)
    made.hear(ESTOPPED, 1.05)
    assert repeats(made, 1.1, 1.2) == [False, False]
    assert made.outcome(1.33) is Outcome.CHANGED


def test_a_request_to_arm_is_not_repeated_blindly():
    made = exchange(ARM, state())
    assert repeats(made, 1.1, 1.15, 1.21, 2.0) == [True, False, False, False]
    made.hear(state(), 2.0)
    assert made.due(2.1) is not None


@pytest.mark.parametrize("mode", ["estopped", "stopped", "disarmed"])
def test_a_request_to_disarm_is_repeated_whatever_changes(mode):
    made = exchange(OFF, ARMED)
    made.halt(1.0)
    made.hear(state("armed", epoch=8, sender=B), 1.05)
    assert repeats(made, 1.11, 1.22, 3.0) == [True, True, True]


def test_a_refusal_is_reported_with_the_drivers_reason():
    before = state("estopped", refused=[("arm: only people may arm", 3), ("late", 1)])
    made = exchange(ARM, before)
    now = state("estopped", refused=[("arm: only people may arm", 3), ("arm: e-stop is latched", 1), ("late", 2)])
    made.hear(now, 1.1)
    assert made.due(1.15) is None
    assert made.outcome(1.41) is Outcome.REFUSED
    assert made.refusal == "e-stop is latched"


def test_a_refusal_of_anothers_request_does_not_hide_a_confirmation():
    made = exchange(ARM, state())
    made.hear(state(refused=[("arm: only people may arm", 1)]), 1.1)
    made.hear(ARMED, 1.2)
    assert made.outcome(1.5) is Outcome.CONFIRMED


def test_arming_for_the_armed_sender_again_needs_a_later_state():
    made = exchange(ARM, ARMED)
    made.hear(ARMED, 1.05)
    assert made.outcome(1.1) is None
    made.hear(ARMED, 1.15)
    assert made.outcome(1.15) is Outcome.CONFIRMED


@pytest.mark.parametrize(
    ("request_", "before", "matched", "expected"),
    [
        (ARM, None, True, Outcome.NO_DRIVER),
        (OFF, None, False, Outcome.NOT_SENT),
        (OFF, None, True, Outcome.NO_CONFIRMATION),
        (OFF, ARMED, True, Outcome.NO_CONFIRMATION),
        (ARM, state(), False, Outcome.NOT_SENT),
        (ARM, state(), True, Outcome.NO_CONFIRMATION),
    ],
)
@pytest.mark.promise("P52")
def test_after_five_seconds_the_outcome_tells_what_is_missing(request_, before, matched, expected):
    made = exchange(request_, before)
    made.matched = matched
    assert made.outcome(4.9) is None
    assert made.outcome(6.0) is expected


@pytest.mark.promise("P52")
def test_only_a_request_to_arm_that_was_sent_is_taken_back_from_the_start_that_it_was_for():
    assert exchange(ARM, state()).withdrawal() == ArmRequest(False, False, "", 7)
    assert exchange(RESET, ESTOPPED).withdrawal() == ArmRequest(False, False, "", 7)
    assert exchange(ARM).withdrawal() is None, "nothing was sent"
    assert exchange(OFF, ARMED).withdrawal() is None


def test_the_page_of_reasons_lists_every_outcome():
    page = (ROOT / "docs" / "reasons.md").read_text(encoding="utf-8")
    listed = re.findall(r"^\| `Outcome` \| `([^`]+)` \|", page, re.MULTILINE)
    assert listed == [outcome.value for outcome in Outcome]


def test_what_has_arrived_counts_although_a_publication_took_all_of_the_time(monkeypatch):
    """On a busy machine the first one loads the codec for seconds; a driver that had disarmed was said to be silent."""
    clock = SimpleNamespace(s=0.0)
    monkeypatch.setattr(arm.time, "monotonic", lambda: clock.s)
    monkeypatch.setattr(arm.time, "sleep", lambda pause_s: setattr(clock, "s", clock.s + pause_s))
    arrived = [[], [ARMED, state(reason="disarm request"), state(reason="disarm request")]]

    def drain():
        found = arrived.pop(0) if arrived else []
        return [Sample("agilo/driver", each, int(clock.s * 1e9), n, B) for n, each in enumerate(found)]

    def publish(message):
        clock.s += 10.0

    publisher = SimpleNamespace(publish=publish, matched=lambda: True)
    session = SimpleNamespace(publisher=lambda *key: publisher, inbox=lambda *key, **more: SimpleNamespace(drain=drain))
    outcome, _ = arm._exchange(session, "agilo", OFF, SimpleNamespace(requested=False))
    assert outcome is Outcome.CONFIRMED
