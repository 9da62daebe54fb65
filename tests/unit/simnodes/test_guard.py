"""The guard, with exact values: each test fails when the protection in its name is removed."""

import math

import pytest

from tailor.simnodes.guard import MAX_JUMP, TIMEOUT_NS, ArmRefusal, CommandRefusal, Guard, Limit, Mode, Reason

A, B = "a" * 32, "b" * 32
MS = 1_000_000
LIMITS = (Limit(-0.5, 1.0), Limit(-2.0, 2.0))
ZERO = (0.0, 0.0)


def fresh():
    return Guard(LIMITS, epoch=7)


def armed(at_ns=0):
    guard = fresh()
    assert guard.arm(at_ns, A) is None
    return guard


def moving(at_ns=0):
    guard = armed(at_ns)
    assert guard.command(at_ns, A, 1, (0.4, -1.0)) is None
    assert guard.output(at_ns) == (0.4, -1.0)
    return guard


@pytest.mark.promise("P1")
def test_the_timeout_is_300_ms():
    assert TIMEOUT_NS == 300 * MS


def test_the_guard_starts_disarmed_and_refuses_commands():
    guard = fresh()
    assert (guard.mode, guard.sender, guard.accepted) == (Mode.DISARMED, "", 0)
    assert guard.command(0, A, 1, (0.4, 0.0)) is CommandRefusal.NOT_ARMED
    assert guard.output(0) == ZERO
    assert guard.refused == {CommandRefusal.NOT_ARMED: 1}


def test_an_armed_guard_passes_commands_and_counts_them():
    guard = moving()
    assert guard.command(100 * MS, A, 2, (0.2, 0.5)) is None
    assert guard.output(100 * MS) == (0.2, 0.5)
    assert (guard.accepted, guard.mode, guard.reason, guard.sender) == (2, Mode.ARMED, Reason.NONE, A)
    assert not guard.refused


@pytest.mark.promise("P1")
def test_the_last_command_holds_until_the_end_of_the_timeout_and_no_longer():
    guard = moving()
    assert guard.output(TIMEOUT_NS) == (0.4, -1.0)
    assert guard.mode is Mode.ARMED
    assert guard.output(TIMEOUT_NS + 1) == ZERO
    assert (guard.mode, guard.reason, guard.sender) == (Mode.STOPPED, Reason.COMMAND_TIMEOUT, "")


def test_the_timeout_counts_from_the_latest_valid_command():
    guard = moving()
    assert guard.command(200 * MS, A, 2, (0.3, 0.0)) is None
    assert guard.output(500 * MS) == (0.3, 0.0)
    assert guard.output(500 * MS + 1) == ZERO


def test_arming_without_a_command_times_out_too():
    guard = armed(50 * MS)
    guard.output(350 * MS)
    assert guard.mode is Mode.ARMED
    guard.output(350 * MS + 1)
    assert guard.mode is Mode.STOPPED


def test_arming_again_does_not_extend_the_timeout():
    guard = moving()
    assert guard.arm(250 * MS, A) is None
    assert guard.output(300 * MS + 1) == ZERO


def test_a_refused_command_does_not_extend_the_timeout():
    guard = moving()
    assert guard.command(250 * MS, A, 1, (0.1, 0.0)) is CommandRefusal.OLD_SEQUENCE
    assert guard.command(250 * MS, A, 2, (math.nan, 0.0)) is CommandRefusal.NOT_FINITE
    assert guard.output(300 * MS + 1) == ZERO


@pytest.mark.promise("P1")
def test_a_command_after_the_timeout_is_refused_until_armed_again():
    guard = moving()
    assert guard.command(300 * MS + 1, A, 2, (0.1, 0.0)) is CommandRefusal.NOT_ARMED
    assert guard.arm(400 * MS, A) is None
    assert guard.output(400 * MS) == ZERO, "arming alone does not move"
    assert guard.command(400 * MS, A, 2, (0.1, 0.0)) is None
    assert guard.output(400 * MS) == (0.1, 0.0)


def test_a_command_stamped_before_the_last_one_does_not_shorten_its_time():
    guard = moving(100 * MS)
    assert guard.command(50 * MS, A, 2, (0.2, 0.0)) is None
    assert guard.output(400 * MS) == (0.2, 0.0)
    assert guard.output(400 * MS + 1) == ZERO


@pytest.mark.promise("P14")
@pytest.mark.parametrize("sequence", [1, 0, -5])
def test_a_sequence_that_does_not_rise_is_refused_and_the_old_command_stays(sequence):
    guard = moving()
    assert guard.command(10 * MS, A, sequence, (0.1, 0.0)) is CommandRefusal.OLD_SEQUENCE
    assert guard.output(10 * MS) == (0.4, -1.0)
    assert guard.refused == {CommandRefusal.OLD_SEQUENCE: 1}
    assert guard.accepted == 1


def test_sequence_numbers_may_skip():
    guard = moving()
    assert guard.command(10 * MS, A, 90, (0.1, 0.0)) is None
    assert guard.command(20 * MS, A, 89, (0.2, 0.0)) is CommandRefusal.OLD_SEQUENCE


@pytest.mark.promise("P14")
def test_recorded_commands_are_refused_even_after_arming_again():
    guard = moving()
    guard.disarm(Reason.DISARM_REQUEST)
    assert guard.arm(50 * MS, A) is None
    assert guard.command(50 * MS, A, 1, (0.4, -1.0)) is CommandRefusal.OLD_SEQUENCE
    assert guard.output(50 * MS) == ZERO


def test_a_refused_command_does_not_use_up_its_sequence_number():
    guard = moving()
    assert guard.command(10 * MS, A, 9, (5.0, 0.0)) is CommandRefusal.BEYOND_LIMIT
    assert guard.command(20 * MS, A, 2, (0.1, 0.0)) is None


def test_another_sender_is_refused_and_has_a_sequence_of_its_own():
    guard = moving()
    assert guard.command(10 * MS, B, 99, (0.9, 0.0)) is CommandRefusal.OTHER_SENDER
    assert guard.output(10 * MS) == (0.4, -1.0)
    assert guard.command(20 * MS, A, 2, (0.3, 0.0)) is None
    guard.disarm(Reason.DISARM_REQUEST)
    assert guard.arm(30 * MS, B) is None
    assert guard.command(30 * MS, B, 0, (0.9, 0.0)) is None


@pytest.mark.promise("P14")
def test_another_sender_cannot_arm_over_the_first():
    guard = moving()
    assert guard.arm(10 * MS, B) is ArmRefusal.OTHER_SENDER_ARMED
    assert guard.sender == A
    assert guard.arm(300 * MS + 1, B) is None, "after the stop any sender may arm"
    assert guard.sender == B
    assert guard.output(300 * MS + 1) == ZERO


@pytest.mark.promise("P19")
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_number_that_is_not_finite_is_refused_on_every_axis(bad, axis):
    guard = moving()
    values = [0.1, 0.1]
    values[axis] = bad
    assert guard.command(10 * MS, A, 2, values) is CommandRefusal.NOT_FINITE
    assert guard.output(10 * MS) == (0.4, -1.0)


@pytest.mark.promise("P19")
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("side", ["lower", "upper"])
def test_the_limit_itself_is_legal_and_the_next_float_is_refused_not_clamped(axis, side):
    guard = moving()
    bound = getattr(LIMITS[axis], side)
    values = [0.0, 0.0]
    values[axis] = bound
    assert guard.command(10 * MS, A, 2, values) is None
    assert guard.output(10 * MS) == tuple(values)
    values[axis] = math.nextafter(bound, math.inf if side == "upper" else -math.inf)
    assert guard.command(20 * MS, A, 3, values) is CommandRefusal.BEYOND_LIMIT
    assert guard.output(20 * MS)[axis] == bound


@pytest.mark.parametrize("values", [(), (0.1,), (0.1, 0.1, 0.1)])
def test_a_command_with_another_number_of_axes_is_refused(values):
    assert moving().command(10 * MS, A, 2, values) is CommandRefusal.WRONG_COUNT


@pytest.mark.promise("P38")
def test_an_estop_sets_zero_at_once_and_latches():
    guard = moving()
    guard.estop()
    assert guard.output(10 * MS) == ZERO
    assert (guard.mode, guard.reason, guard.sender) == (Mode.ESTOPPED, Reason.ESTOP, "")
    assert guard.command(20 * MS, A, 2, (0.1, 0.0)) is CommandRefusal.NOT_ARMED
    assert guard.arm(30 * MS, A) is ArmRefusal.ESTOP_LATCHED
    guard.disarm(Reason.DISARM_REQUEST)
    guard.stop("motor fault")
    assert guard.mode is Mode.ESTOPPED
    assert guard.arm(40 * MS, A, reset=True) is None
    assert guard.mode is Mode.ARMED
    assert guard.output(40 * MS) == ZERO


def test_estop_works_while_disarmed():
    guard = fresh()
    guard.estop()
    assert guard.arm(0, A) is ArmRefusal.ESTOP_LATCHED


@pytest.mark.promise("P38")
def test_reset_for_another_epoch_does_not_unlatch():
    guard = moving()
    guard.estop()
    assert guard.arm(0, A, epoch=8, reset=True) is ArmRefusal.OTHER_EPOCH
    assert guard.mode is Mode.ESTOPPED


def test_disarming_sets_zero_at_once():
    guard = moving()
    guard.disarm(Reason.DISARM_REQUEST, "by a person")
    assert guard.output(10 * MS) == ZERO
    assert (guard.mode, guard.sender) == (Mode.DISARMED, "")
    assert (guard.reason, guard.detail) == (Reason.DISARM_REQUEST, "by a person")


def test_a_driver_may_stop_for_a_fault_of_its_own():
    guard = moving()
    guard.stop("motor fault")
    assert guard.output(10 * MS) == ZERO
    assert (guard.mode, guard.reason, guard.detail) == (Mode.STOPPED, Reason.DRIVER_FAULT, "motor fault")


def test_arming_clears_the_reason_of_the_last_stop():
    guard = fresh()
    guard.stop("motor fault")
    assert guard.arm(0, A) is None
    assert (guard.reason, guard.detail) == (Reason.NONE, "")


def test_arming_for_another_epoch_or_without_a_sender_is_refused():
    guard = fresh()
    assert guard.arm(0, A, epoch=8) is ArmRefusal.OTHER_EPOCH
    assert guard.arm(0, "") is ArmRefusal.NO_SENDER
    assert guard.mode is Mode.DISARMED
    assert guard.arm(0, A, epoch=7) is None


@pytest.mark.promise("P22")
def test_time_that_goes_back_neither_stops_nor_extends():
    guard = moving(1000 * MS)
    assert guard.output(500 * MS) == (0.4, -1.0)
    assert guard.output(1300 * MS + 1) == ZERO


def test_the_timeout_can_be_configured():
    guard = Guard(LIMITS, epoch=1, timeout_ns=100 * MS)
    guard.arm(0, A)
    guard.command(0, A, 1, (0.1, 0.0))
    assert guard.output(100 * MS) == (0.1, 0.0)
    assert guard.output(100 * MS + 1) == ZERO


@pytest.mark.promise("P14")
def test_a_forged_number_far_ahead_does_not_lock_the_sender_out():
    guard = moving()
    assert guard.command(10 * MS, A, 2**63 - 1, (1.0, 0.0)) is CommandRefusal.SEQUENCE_JUMP
    assert guard.command(20 * MS, A, 1 + MAX_JUMP + 1, (1.0, 0.0)) is CommandRefusal.SEQUENCE_JUMP
    assert guard.output(20 * MS) == (0.4, -1.0)
    assert guard.command(30 * MS, A, 2, (0.3, 0.0)) is None
    assert guard.command(40 * MS, A, 2 + MAX_JUMP, (0.2, 0.0)) is None


def test_after_arming_numbers_may_have_gone_on_but_not_back():
    """A partition lasts longer than the time-out: people arm again, and the executive has counted on."""
    guard = moving()
    guard.output(TIMEOUT_NS + 1)
    assert guard.arm(10_000 * MS, A) is None
    assert guard.command(10_000 * MS, A, 1, (0.4, 0.0)) is CommandRefusal.OLD_SEQUENCE
    assert guard.command(10_000 * MS, A, 900, (0.4, 0.0)) is None


@pytest.mark.promise("P13")
@pytest.mark.parametrize("offset_ns", [0, 10**18, -5_000 * MS])
def test_commands_that_are_held_up_are_refused_whatever_the_clocks_distance(offset_ns):
    guard = armed()
    clock = 10_000 * MS + offset_ns  # the sender's, at our time 0
    assert guard.command(20 * MS, A, 1, (0.4, 0.0), clock) is None
    assert guard.command(110 * MS, A, 2, (0.4, 0.0), clock + 100 * MS) is None, "10 ms faster than the first"
    assert guard.command(409 * MS, A, 3, (0.5, 0.0), clock + 99 * MS) is None, "300 ms slower than the fastest"
    assert guard.command(410 * MS, A, 4, (0.6, 0.0), clock + 99 * MS) is CommandRefusal.LATE
    assert guard.output(709 * MS) == (0.5, 0.0)
    assert guard.output(710 * MS) == ZERO


@pytest.mark.promise("P13")
def test_a_delay_that_creeps_up_stops_the_robot():
    """Each command a little later than the one before: none of them is late by much, all of them are in the end."""
    guard = armed()
    for k in range(1, 30):
        guard.command(k * 140 * MS, A, k, (0.4, 0.0), k * 100 * MS)  # 40 ms a command
    assert (guard.mode, guard.refused[CommandRefusal.LATE] > 0) == (Mode.STOPPED, True)


@pytest.mark.promise("P13")
def test_the_stamp_of_the_newest_command_since_arming_is_kept():
    guard = armed()
    assert guard.command_stamp_ns == 0
    guard.command(0, A, 1, (0.4, 0.0), 1_000 * MS)
    assert guard.command(100 * MS, A, 2, (0.4, 0.0), 1_100 * MS) is None
    assert guard.command(110 * MS, A, 3, (0.4, 0.0), 800 * MS) is CommandRefusal.LATE
    assert guard.command(110 * MS, "c" * 32, 3, (0.4, 0.0), 9_000 * MS) is CommandRefusal.OTHER_SENDER
    assert guard.command_stamp_ns == 1_100 * MS, "refused ones do not count"
    guard.disarm(Reason.DISARM_REQUEST)
    assert guard.arm(200 * MS, A) is None
    assert guard.command_stamp_ns == 0, "nor does one before arming"


def test_a_command_without_a_stamp_is_judged_by_its_arrival_alone():
    guard = armed()
    assert guard.command(0, A, 1, (0.4, 0.0)) is None
    assert guard.command(299 * MS, A, 2, (0.4, 0.0)) is None
    assert guard.command(598 * MS, A, 3, (0.4, 0.0)) is None


@pytest.mark.promise("P41")
@pytest.mark.parametrize("cause", ["disarm", "stop", "estop", "silence", "restart"])
def test_leave_is_for_one_arming_and_revoked_by_whatever_stops(cause):
    guard = Guard(LIMITS, epoch=7, leave=A)
    if cause == "silence":
        assert guard.arm(0, A, by_people=False) is None
        guard.output(TIMEOUT_NS + 1)
    elif cause == "restart":
        guard = Guard(LIMITS, epoch=8)
    else:
        arguments = {"stop": ["motor failed"], "disarm": [Reason.DISARM_REQUEST]}.get(cause, [])
        getattr(guard, cause)(*arguments)
    assert guard.arm(10**9, A, by_people=False, reset=True) is not None
    assert guard.mode is not Mode.ARMED
    assert guard.arm(10**9, A, reset=True) is None, "people may"


def test_leave_is_for_one_sender():
    guard = Guard(LIMITS, epoch=7, leave=A)
    assert guard.arm(0, B, by_people=False) is ArmRefusal.PEOPLE_ONLY
    assert guard.arm(0, A, by_people=False) is None
    assert guard.mode is Mode.ARMED
