"""Sensors that an executive requires are judged even if no message of theirs ever arrives."""

import json
from dataclasses import asdict, replace

import pytest

from tailor.executive.composition import ExecutiveConfig, build_context, provenance, rebuild_context
from tailor.schemas import messages as m
from tailor.tools.status.executives import MAX_REQUIRED
from tailor.tools.status.picture import Finding
from tests.unit.tools.status.bus_feed import EXECUTIVE, OTHER, Feed, driver, problems, status

IDLE = {
    "DISARMED": {"driver": driver("disarmed", "just started", ""), "status": status("DISARMED", "driver not armed")},
    "READY": {"status": status("READY")},
}


def requiring(*keys: str, rate_hz: object = 50.0) -> m.Provenance:
    return m.Provenance(0, json.dumps({"required": dict.fromkeys(keys, rate_hz)}))


@pytest.mark.parametrize("mode", IDLE)
def test_a_required_sensor_that_never_spoke_is_a_problem_before_the_robot_is_armed(mode):
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom", "agilo/pose"), EXECUTIVE)
    picture = feed.run(1.5, **IDLE[mode])
    assert picture.problems == (Finding("topic missing", "agilo/pose, required, not received in 1.5 s"),)
    assert asdict(picture)["executives"][0]["required"] == {"agilo/odom": 50.0, "agilo/pose": 50.0}


def test_with_all_required_sensors_the_system_is_healthy():
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom"), EXECUTIVE)
    assert feed.run(1.5).healthy


def test_a_required_sensor_that_fell_silent_is_stale_and_not_missing():
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom"), EXECUTIVE)
    feed.run(1.5)
    assert problems(feed.run(1.5, without=("odom",))) == ["topic stale"]


@pytest.mark.parametrize(("seconds", "expected"), [(0.4, []), (0.6, ["topic missing"])])
def test_nothing_is_missing_before_its_limit_has_passed(seconds, expected):
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom"), EXECUTIVE)
    assert problems(feed.run(seconds, without=("odom",))) == expected


def test_what_a_silent_executive_required_is_not_judged():
    feed = Feed()
    feed.put("provenance", requiring("b21/odom"), OTHER)
    feed.put("status", status(), OTHER)
    assert feed.run(2.0).healthy


def test_topics_without_a_limit_and_foreign_texts_are_not_required():
    feed = Feed()
    feed.put("provenance", requiring("agilo/ball", "x" * 300, "agilo/*/odom", "rt/chatter"), EXECUTIVE)
    assert feed.run(1.5).healthy
    for text in ("", "[1]", '{"required": 3}', '{"required": ["agilo/pose"]}', "[" * 100_000):
        feed.put("provenance", m.Provenance(0, text), EXECUTIVE)
        assert feed.picture().executives[0].required == {}


@pytest.mark.parametrize("rate", ["x", None, True, -1, 1e999, 10**400])
def test_a_rate_that_is_none_leaves_the_topics(rate):
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom", rate_hz=rate), EXECUTIVE)
    assert feed.run(1.5).executives[0].required == {"agilo/odom": 50.0}


@pytest.mark.parametrize(("declared_hz", "expected"), [(50.0, ["topic slow"]), (10.0, [])])
def test_a_required_sensor_is_slow_by_the_rate_that_its_driver_declares(declared_hz, expected):
    feed = Feed()
    feed.put("provenance", requiring("agilo/odom", rate_hz=declared_hz), EXECUTIVE)
    for _ in range(20):
        feed.run(0.1, without=("odom",))
        feed.put("odom", m.Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2))
    picture = feed.picture()
    assert problems(picture) == expected
    assert {topic.key: topic.nominal_hz for topic in picture.topics}["agilo/odom"] == declared_hz


def test_a_flood_of_required_topics_stays_bounded():
    feed = Feed()
    feed.put("provenance", requiring(*(f"robot{k}/odom" for k in range(1000))), EXECUTIVE)
    assert len(feed.run(1.5).problems) == MAX_REQUIRED


def test_an_executive_publishes_what_its_domain_requires_with_the_rates_of_its_driver():
    config = ExecutiveConfig("soccer", "approach")
    context = build_context(config, EXECUTIVE)
    assert provenance(config, context)["required"] == {"agilo/odom": 50.0, "agilo/pose": 12.5}
    slower = replace(context, sensor_rates_hz={**context.sensor_rates_hz, "odom": 10.0})
    described = provenance(config, slower)
    assert described["required"] == {"agilo/odom": 10.0, "agilo/pose": 12.5}
    assert rebuild_context(described).sensor_rates_hz == {"odom": 10.0, "pose": 12.5}
