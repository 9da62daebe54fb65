"""The model of a running system: what it knows after which messages, and what it judges as a problem."""

import math
from dataclasses import replace

import pytest

from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import BallPercept
from tailor.schemas.topics import key_of
from tailor.tools.status.foreign import MAX_KEYS, MAX_REASONS, ForeignCounts
from tailor.tools.status.picture import Finding
from tailor.tools.status.system_model import MAX_ROBOTS
from tests.unit.tools.status.bus_feed import DRIVER, EXECUTIVE, OTHER, Feed, driver, problems, raw_of, status, tick

ODOMETRY = m.Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2)


def test_a_system_of_which_every_part_publishes_in_time_is_healthy():
    picture = Feed().run(2.0)
    assert (picture.healthy, picture.problems, picture.observed_s) == (True, (), 2.0)
    (executive,), (robot,) = picture.executives, picture.drivers
    assert (executive.sender, executive.mode, executive.action, executive.silent) == (
        EXECUTIVE,
        "EXECUTING",
        "goToPose",
        False,
    )
    assert (robot.robot, robot.mode, robot.armed_for, robot.accepted, robot.refused) == (
        "agilo",
        "armed",
        "executive",
        5,
        {"other sender": 2},
    )
    assert {topic.key: topic.rate_hz for topic in picture.topics} == {
        "agilo/driver": 10.0, "agilo/odom": 50.0, "exec/status": 10.0, "exec/tick": 10.0
    }  # fmt: skip


def test_a_disarmed_robot_and_a_waiting_executive_are_healthy():
    idle = {"driver": driver("disarmed", "just started", ""), "status": status("DISARMED", "driver not armed")}
    assert Feed().run(2.0, **idle).healthy


def test_an_empty_bus_has_neither_driver_nor_executive():
    assert problems(Feed().picture()) == ["no driver", "no executive"]


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        ({"driver": driver("stopped", "driver fault", "")}, ("driver stopped", "agilo: driver fault")),
        ({"driver": driver("estopped", "e-stop", "")}, ("e-stop latched", "agilo")),
        ({"driver": driver(armed_sender=OTHER)}, ("driver obeys unknown sender", "agilo obeys efefefef")),
        ({"status": status("HOLDING", "input stale", "odom")}, ("executive holds", "input stale: odom")),
        ({"status": status("FAULT", "repeated failure", "kick")}, ("executive fault", "repeated failure: kick")),
        ({"tick": tick(skipped=1)}, ("ticks skipped", "20 within the last minute")),
    ],
)  # fmt: skip
def test_what_a_part_reports_is_judged(part, expected):
    assert Feed().run(2.0, **part).problems == (Finding(*expected),)


@pytest.mark.parametrize(
    ("part", "silent_s", "expected"),
    [
        ("driver", 0.5, []),
        ("driver", 0.6, ["driver silent", "topic stale"]),
        ("odom", 0.6, ["topic stale"]),
        ("status", 0.5, []),
        ("status", 0.6, ["driver obeys unknown sender", "executive silent"]),
    ],
)
def test_a_part_that_falls_silent_is_named_after_half_a_second(part, silent_s, expected):
    feed = Feed()
    feed.run(2.0)
    feed.now_s -= 0.02  # so that the last message of a 50 Hz topic comes now
    feed.run(0.02)
    feed.put(
        part,
        {"driver": driver(), "odom": ODOMETRY, "status": status()}[part],
        EXECUTIVE if part == "status" else DRIVER,
    )
    assert problems(feed.run(silent_s, without=(part,))) == expected


def test_a_sensor_at_half_its_rate_is_slow():
    feed = Feed()
    for _ in range(20):
        feed.run(0.04, without=("odom",))
        feed.put("odom", ODOMETRY)
    assert problems(feed.picture()) == ["topic slow"]
    assert feed.picture().problems[0].detail == "agilo/odom at 25.0 of 50 Hz"


def test_commands_may_rest_and_a_ball_may_be_out_of_sight():
    feed = Feed()
    feed.put("cmd_vel", m.VelocityCommand(0, 0.0, 0.0), EXECUTIVE)
    feed.put("ball", BallPercept(0, 1.0, 0.0, 0.01, 0.01, 0.0), DRIVER)
    assert feed.run(8.0).healthy


def test_a_restarted_executive_replaces_the_silent_one():
    feed = Feed()
    feed.run(1.0)
    feed.now_s += 2.0
    feed.put("status", status("DISARMED", "driver obeys another"), OTHER)
    picture = feed.picture()
    assert [(each.sender, each.silent) for each in picture.executives] == [(OTHER, False), (EXECUTIVE, True)]
    assert picture.restarts == 1
    assert "several executives" not in problems(picture)
    feed.now_s += 100.0
    feed.put("status", status(), OTHER)
    assert [each.sender for each in feed.picture().executives] == [OTHER], "after a minute it is forgotten"


def test_two_executives_at_once_are_a_problem():
    feed = Feed()
    feed.run(1.0)
    feed.put("status", status(), OTHER)
    picture = feed.picture()
    assert problems(picture) == ["several executives", "several senders"]
    assert picture.restarts == 0


def test_a_driver_with_another_epoch_has_restarted():
    feed = Feed()
    assert feed.run(1.0).drivers[0].restarts == 0
    assert feed.run(1.0, driver=driver(epoch=8)).drivers[0].restarts == 1


def test_several_robots_are_listed_by_name():
    feed = Feed()
    feed.run(1.0)
    feed.put("driver", driver("disarmed", "just started", ""), OTHER, "lab/powercube")
    feed.put("joint_truth", m.JointState(0, (), (), (), ()), OTHER, "lab/powercube")
    picture = feed.picture()
    assert [each.robot for each in picture.drivers] == ["agilo", "lab/powercube"]
    assert "lab/powercube/sim/joints" in [topic.key for topic in picture.topics]
    assert picture.healthy


def launched(state="running", status=""):
    return m.ProcessStates(
        0,
        (
            m.ProcessState("sim", 17, "running", 1, 0.1, "", DRIVER),
            m.ProcessState("record", 18, state, 2, 0.1, status, OTHER),
        ),
    )


@pytest.mark.parametrize(
    ("states", "expected"),
    [
        (launched(), ()),
        (launched("waiting"), (Finding("process not running", "record is waiting after 2 starts"),)),
        (launched(status="disk: full"), (Finding("process lacks something", "record: disk: full"),)),
    ],
)
def test_the_launchers_processes_are_judged(states, expected):
    feed = Feed()
    assert feed.run(2.0).launcher is None
    feed.put("processes", states, OTHER)
    picture = feed.run(2.0)
    assert picture.problems == expected
    assert [process.name for process in picture.launcher.processes] == ["sim", "record"]
    assert feed.run(2.0).problems == (Finding("launcher silent", "for 4.0 s"),)


def test_a_second_publisher_of_a_command_is_a_problem():
    feed = Feed()
    for sender in (EXECUTIVE, OTHER):
        feed.put("cmd_vel", m.VelocityCommand(0, 0.1, 0.0), sender)
    assert problems(feed.run(0.9)) == ["several senders"]
    assert feed.run(1.0).healthy, "a second later the other one has gone"


def test_damaged_messages_are_refused_and_counted_by_key_and_reason():
    feed = Feed()
    good = raw_of(key_of("odom", "agilo"), ODOMETRY)
    feed.raw(replace(good, payload=good.payload[:9]))
    feed.raw(replace(good, payload=b"\0" * 5000))
    feed.raw(replace(good, attachment=b"x"))
    feed.raw(replace(good, is_put=False))
    feed.raw(replace(good, encoding="application/cdr;std_msgs/msg/Bool"))
    feed.raw(raw_of("agilo/odom", replace(ODOMETRY, x=math.nan)))
    feed.raw(good)
    feed.raw(good)
    picture = feed.run(2.0)
    assert picture.foreign.refused == {
        "agilo/odom": {
            "malformed": 1, "too long": 1, "bad attachment": 1, "not a put": 1, "other type": 1,
            "not finite (pose.pose.position.x)": 1, "repeated": 1,
        }
    }  # fmt: skip
    assert problems(picture) == ["messages refused"]


def test_a_stranger_who_damages_field_after_field_grows_no_observer():
    counts = ForeignCounts()
    for number in range(1000):
        counts.refused("agilo/odom", "not finite", f"field_{number}")
    refused = counts.view().refused["agilo/odom"]
    assert (len(refused), refused["not finite"]) == (MAX_REASONS + 1, 1000 - MAX_REASONS)


def test_a_frozen_sender_that_repeats_itself_is_not_fresh():
    feed = Feed()
    feed.run(1.0)
    frozen = raw_of("agilo/odom", ODOMETRY, sequence=10**6)
    for _ in range(40):
        feed.run(0.02, without=("odom",))
        feed.raw(frozen)
    assert "topic stale" in problems(feed.picture())


def test_foreign_keys_are_counted_and_no_problem():
    feed = Feed()
    for key in ("rt/chatter", "**", "/odom", "odom", "exec/whatever", "agilo/*/odom", "x" * 300 + "/odom"):
        feed.raw(raw_of(key, ODOMETRY))
    picture = feed.run(2.0)
    assert set(picture.foreign.unknown.values()) == {1}
    assert len(picture.foreign.unknown) == 7
    assert picture.healthy


def test_a_flood_of_invented_names_stays_bounded():
    feed = Feed()
    feed.run(1.0)
    for k in range(2000):
        feed.raw(raw_of(f"junk/{k}", ODOMETRY))
        feed.raw(raw_of(f"robot{k}/odom", ODOMETRY))
        feed.raw(replace(raw_of(f"bad{k}/odom", ODOMETRY), payload=b""))
        feed.put("status", status(), f"{k:032x}")
        feed.put("odom", ODOMETRY, f"{k:032x}")
    picture = feed.picture()
    assert sum(picture.foreign.unknown.values()) == 2000 + 2000 - (MAX_ROBOTS - 1)
    assert len(picture.foreign.unknown) == MAX_KEYS + 1
    assert len(picture.foreign.refused) == MAX_KEYS + 1
    assert len(picture.topics) <= 3 + MAX_ROBOTS
    assert len(picture.executives) <= 8


def test_privileges_come_from_the_provenance_and_foreign_content_leaves_them_empty():
    feed = Feed()
    feed.run(1.0)
    for text in ("", "[1]", '{"realtime": 3}', "[" * 100_000):
        feed.put("provenance", m.Provenance(0, text), EXECUTIVE)
        assert feed.picture().executives[0].realtime == {}
    feed.put("provenance", m.Provenance(0, '{"realtime": {"scheduler": "fifo 50"}}'), EXECUTIVE)
    assert feed.picture().executives[0].realtime == {"scheduler": "fifo 50"}


@pytest.mark.parametrize("last", ["provenance", "processes"])
def test_a_view_is_incomplete_until_a_live_executive_and_a_launcher_have_published_what_they_do_once_a_second(last):
    feed = Feed()
    slow = {"provenance": m.Provenance(0, "{}"), "processes": m.ProcessStates(0, ())}
    message = slow.pop(last)
    assert not feed.model.incomplete(round(feed.now_s * 1e9)), "nobody is there"
    feed.run(0.3)
    for name, other in slow.items():
        feed.put(name, other, EXECUTIVE)
    assert feed.model.incomplete(round(feed.now_s * 1e9))
    feed.put(last, message, EXECUTIVE)
    assert not feed.model.incomplete(round(feed.now_s * 1e9))
