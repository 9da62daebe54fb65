"""Inbox, attachment and arrival times without a bus."""

import math
from dataclasses import replace

import pytest

from tailor.runtime.bus import inbox as module
from tailor.runtime.bus.arrival import Instant, arrival_ns
from tailor.runtime.bus.attachment import UNSIGNED, Origin, pack, unpack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import EVENT_DEPTH, Inbox, Raw, is_state
from tailor.runtime.bus.latch import MAX_SENDERS, EStopLatch
from tailor.runtime.bus.publisher import Publisher
from tailor.schemas.codec import encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import EStop, Odometry, Sample, VelocityCommand
from tailor.schemas.topics import TOPICS

SENDER = "0123456789abcdef" * 2
MS = 1_000_000


class Line:
    """Raw samples that wait, as a subscription gives them."""

    def __init__(self, *raws):
        self.raws = list(raws)

    def receive(self):
        return self.raws.pop(0) if self.raws else None


def raw(message, key="agilo/odom", **changes):
    fields = {
        "key": key,
        "payload": encode(message),
        "attachment": pack(Origin(7, 123, SENDER)),
        "encoding": encoding_of(type(message)),
        "is_put": True,
        "received_wall_ns": None,
    }
    return Raw(**{**fields, **changes})


def inbox(*raws, topic="odom", key="agilo/odom", wall=0):
    return Inbox([(TOPICS[topic], key, Line(*raws))], now=lambda: 0, wall=lambda: wall)


ODOMETRY = Odometry(5, 1.0, 2.0, 0.0, 0.5, 0.25)


def test_a_sample_has_the_origin_of_its_attachment():
    assert inbox(raw(ODOMETRY)).drain(9) == (Sample("agilo/odom", ODOMETRY, 9, 7, SENDER),)


def test_an_empty_inbox_gives_nothing():
    assert inbox().drain(9) == ()


@pytest.mark.promise("P18")
@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"key": "agilo/**"}, "other key"),
        ({"key": "nomad/odom"}, "other key"),
        ({"is_put": False}, "not a put"),
        ({"encoding": "application/cdr;std_msgs/msg/Bool"}, "other type"),
        ({"attachment": b"short"}, "bad attachment"),
        ({"payload": b"\0\1\0\0"}, "malformed"),
        ({"payload": bytes(5000)}, "too long"),
    ],
)
def test_rejected_samples_are_counted_by_reason(changes, reason):
    box = inbox(raw(ODOMETRY, **changes), raw(ODOMETRY))
    assert len(box.drain(9)) == 1
    assert box.rejected == {("agilo/odom", reason): 1}


def test_the_field_of_a_number_that_is_not_finite_is_kept_by_key():
    received = inbox(raw(replace(ODOMETRY, x=math.nan)), raw(replace(ODOMETRY, v=math.inf)), raw(ODOMETRY))
    received.drain()
    assert received.refused_fields == {"agilo/odom": "not finite (twist.twist.linear.x)"}
    assert received.rejected["agilo/odom", "not finite"] == 2


def test_an_unsigned_publication_of_another_ros_node_is_accepted():
    samples = inbox(raw(ODOMETRY, attachment=None, encoding="zenoh/bytes")).drain(9)
    assert [(s.sequence, s.sender) for s in samples] == [(0, "")]


def numbered(message, number, key="agilo/odom", sender=SENDER):
    return raw(message, key, attachment=pack(Origin(number, 123, sender)))


@pytest.mark.promise("P17")
def test_a_flood_is_drained_in_bounded_portions():
    flood = [numbered(VelocityCommand(0, 0.1, 0.0), number, "agilo/cmd_vel") for number in range(1, 41)]
    assert len(inbox(*flood, topic="cmd_vel", key="agilo/cmd_vel").drain(1)) == EVENT_DEPTH


@pytest.mark.promise("P6")
def test_repeated_messages_of_a_frozen_sensor_are_rejected_but_not_those_of_a_restart_or_replay():
    line = Line(*(numbered(ODOMETRY, number) for number in (7, 7, 7, 8, 8, 3)), numbered(ODOMETRY, 3, sender="ff" * 16))
    box = Inbox([(TOPICS["odom"], "agilo/odom", line)], now=lambda: 0, wall=lambda: 0)
    assert [sample.sequence for sample in box.drain(9)] == [7, 8, 3, 3]
    assert box.rejected == {("agilo/odom", "repeated"): 3}


@pytest.mark.promise("P6")
def test_a_frozen_sensor_stays_rejected_beside_other_senders_of_its_topic():
    line = Line()
    box = Inbox([(TOPICS["odom"], "agilo/odom", line)], now=lambda: 0, wall=lambda: 0)
    frozen, came = numbered(ODOMETRY, 7), []
    for stranger in range(100):
        line.raws.extend((frozen, numbered(ODOMETRY, stranger + 1, sender=f"{stranger:032x}")))
        came += [sample.sequence for sample in box.drain(9) if sample.sender == SENDER]
    assert came == [7]
    assert len(box._last[0]) == module.MAX_SENDERS


def test_a_frozen_sensor_without_numbers_is_accepted():  # a ROS 2 bridge sends none
    assert len(inbox(*[raw(ODOMETRY, attachment=None)] * 3).drain(9)) == 3


def test_states_replace_each_other_events_and_commands_do_not():
    assert [name for name in ("odom", "status", "cmd_vel", "arm_request", "estop") if is_state(TOPICS[name])] == [
        "odom",
        "status",
    ]


@pytest.mark.promise("P17")
def test_junk_does_not_push_a_good_state_out():
    good = raw(ODOMETRY)
    junk = [raw(ODOMETRY, payload=b"x"), raw(ODOMETRY, key="**"), raw(ODOMETRY, is_put=False)]
    box = Inbox([(TOPICS["odom"], "agilo/odom", Line(good, *junk))], lambda: 0, lambda: 0, newest_only=True)
    assert [sample.message for sample in box.drain(9)] == [ODOMETRY]
    assert sum(box.rejected.values()) == 3


def test_of_several_valid_states_the_newest_counts():
    older, newer = raw(ODOMETRY), raw(ODOMETRY, attachment=pack(Origin(8, 124, SENDER)))
    box = Inbox([(TOPICS["odom"], "agilo/odom", Line(older, newer))], lambda: 0, lambda: 0, newest_only=True)
    assert [sample.sequence for sample in box.drain(9)] == [8]


@pytest.mark.promise("P17")
def test_a_strangers_states_do_not_push_the_right_ones_out():
    ours, stranger = raw(ODOMETRY), numbered(ODOMETRY, 99, "agilo/odom", "ee" * 16)
    rows = [(TOPICS["odom"], "agilo/odom", Line(ours, stranger, stranger))]
    box = Inbox(rows, lambda: 0, lambda: 0, newest_only=True)
    assert sorted(sample.sender for sample in box.drain(9)) == sorted([SENDER, "ee" * 16])


def test_of_events_and_commands_all_count_even_where_of_states_only_the_newest_does():
    commands = [numbered(VelocityCommand(0, 0.1, 0.0), number, "agilo/cmd_vel") for number in (1, 2, 3)]
    rows = [(TOPICS["cmd_vel"], "agilo/cmd_vel", Line(*commands))]
    box = Inbox(rows, lambda: 0, lambda: 0, newest_only=True)
    assert [sample.sequence for sample in box.drain(9)] == [1, 2, 3]


def held(number, sender=SENDER):
    return numbered(EStop(False), number, "estop", sender)


JUNK = [
    raw(EStop(True), "**"),
    raw(EStop(True), "estop", payload=b""),
    raw(EStop(True), "estop", is_put=False),
    raw(EStop(True), "estop", attachment=b"short"),
    raw(EStop(True), "estop", encoding="application/cdr;std_msgs/msg/String"),
]


@pytest.mark.promise("P38")
def test_the_estop_is_latched_on_arrival_whatever_floods_its_key():
    latch = EStopLatch(TOPICS["estop"], "estop")
    for each in JUNK * 100:
        latch.offer(each)
    assert latch.receive() is None, "junk does not take the place of a stop"
    stop, hold = raw(EStop(True), "estop"), held(1)
    for each in (hold, stop, *JUNK * 100, *[raw(EStop(True), "estop"), hold] * 100):
        latch.offer(each)
    assert [latch.receive(), latch.receive(), latch.receive()] == [stop, hold, None], "the stop comes first"


@pytest.mark.promise("P38")
def test_the_newest_message_of_every_held_switch_is_kept():
    latch = EStopLatch(TOPICS["estop"], "estop")
    senders = [f"{number:032x}" for number in range(MAX_SENDERS + 5)]
    for number in (1, 2):
        for sender in senders:
            latch.offer(held(number, sender))
    assert latch.receive() == Rejected("too many senders")
    assert [latch.receive() for _ in range(MAX_SENDERS)] == [held(2, s) for s in senders[:MAX_SENDERS]]
    assert latch.receive() is None
    latch.offer(held(3, senders[-1]))
    assert latch.receive() == held(3, senders[-1]), "the place is free again"


def test_what_a_source_drops_is_counted():
    box = inbox(Rejected("too many senders"), held(1), topic="estop", key="estop")
    assert [sample.message for sample in box.drain(9)] == [EStop(False)]
    assert box.rejected == {("estop", "too many senders"): 1}


@pytest.mark.promise("P38")
def test_an_estop_counts_even_if_its_number_was_there_before():
    stop = raw(EStop(True), "estop")
    box = inbox(stop, stop, topic="estop", key="estop")
    assert len(box.drain(9)) == 2, "a recorded stop, played before it, must not hide it"


@pytest.mark.promise("P38")
def test_polling_an_empty_latch_cannot_erase_a_stop_that_arrives_at_that_moment():
    class Written(EStopLatch):
        writes = 0

        def __setattr__(self, name, value):
            type(self).writes += 1
            super().__setattr__(name, value)

    latch = Written(TOPICS["estop"], "estop")
    before = Written.writes
    assert latch.receive() is None
    assert Written.writes == before, "the bus's thread may have written since the read"


def test_arrival_is_the_time_of_reception_not_of_the_drain():
    before, now = Instant(1000 * MS, 5000 * MS), Instant(1100 * MS, 5100 * MS)
    assert arrival_ns(5070 * MS, before, now) == 1070 * MS
    assert arrival_ns(None, before, now) == 1100 * MS


@pytest.mark.promise("P22")
@pytest.mark.parametrize("jump_ns", [3600 * 1000 * MS, -3600 * 1000 * MS])
def test_a_jump_of_the_wall_clock_moves_an_arrival_by_less_than_a_tick(jump_ns):
    before, now = Instant(1000 * MS, 5000 * MS), Instant(1100 * MS, 5100 * MS + jump_ns)
    assert 1000 * MS <= arrival_ns(5070 * MS, before, now) <= 1100 * MS


def test_samples_of_several_topics_come_oldest_first():
    rows = [
        (TOPICS["odom"], "agilo/odom", Line(raw(ODOMETRY, received_wall_ns=80))),
        (TOPICS["estop"], "estop", Line(raw(EStop(True), "estop", received_wall_ns=20))),
    ]
    walls = iter([0, 100])
    box = Inbox(rows, now=lambda: 0, wall=lambda: next(walls))
    assert [(s.key, s.arrival_ns) for s in box.drain(100)] == [("estop", 20), ("agilo/odom", 80)]


def test_an_attachment_has_rmw_zenohs_33_bytes():
    data = pack(Origin(258, 1, SENDER))
    assert data == b"\x02\x01" + bytes(6) + b"\x01" + bytes(7) + b"\x10" + bytes.fromhex(SENDER)
    assert unpack(data) == Origin(258, 1, SENDER)
    assert unpack(None) == UNSIGNED
    assert unpack(data[:-1]) == Rejected("bad attachment")
    assert unpack(data[:16] + b"\x0f" + data[17:]) == Rejected("bad attachment")


class Wire:
    def __init__(self):
        self.sent = []

    def put(self, payload, attachment):
        self.sent.append((payload, attachment))

    def matched(self):
        return True


def test_a_publisher_numbers_and_signs_from_one():
    wire = Wire()
    publisher = Publisher("estop", wire, SENDER, wall=lambda: 99)
    assert [publisher.publish(EStop(True)), publisher.publish(EStop(False))] == [1, 2]
    assert wire.sent == [
        (encode(EStop(True)), pack(Origin(1, 99, SENDER))),
        (encode(EStop(False)), pack(Origin(2, 99, SENDER))),
    ]


def test_raw_bytes_keep_the_origin_that_they_had_or_had_not():
    wire = Wire()
    publisher = Publisher("estop", wire, SENDER)
    publisher.put_raw(b"x", Origin(41, 5, "ff" * 16))
    publisher.put_raw(b"y", UNSIGNED)
    assert wire.sent == [(b"x", pack(Origin(41, 5, "ff" * 16))), (b"y", None)]
