"""The simulated world and its scheduled events."""

import numpy as np
import pytest

from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.simnodes.body import STEP_NS, Reading
from tailor.simnodes.world import Event, World
from tests.support.stand_ins.body import FakeBody

MS = 1_000_000


def make_world(*events):
    return World(FakeBody(), {"x": 2.0}, 3, events)


def test_events_count_from_the_first_accepted_command():
    world = make_world(Event(0.05, {"ball_x": 9.0}))
    world.advance(500 * MS)
    world.begin()
    world.advance(50 * MS)
    assert world.body.state["ball_x"] == 1.0
    world.begin()
    world.advance(10 * MS)
    assert world.body.state["ball_x"] == 9.0


def test_a_reset_brings_back_start_noise_and_events():
    world = make_world(Event(0.0, {"ball_x": 9.0}))
    first = world.body.noise
    world.begin()
    world.advance(50 * MS)
    world.reset()
    assert (world.body.noise, world.time_ns, world.body.state["x"], world.body.state["ball_x"]) == (first, 0, 2.0, 1.0)
    world.advance(50 * MS)
    assert world.body.state["ball_x"] == 1.0
    world.reset(seed=4, start={"x": 1.0})
    assert world.body.noise == np.random.default_rng([4, 1]).normal()
    assert world.body.state["x"] == 1.0


def test_a_world_steps_in_whole_body_steps():
    with pytest.raises(ValueError, match="multiple"):
        make_world().advance(1)


def test_another_start_has_its_own_events_and_none_of_the_world():
    """A soak put a ball into its robot: of 72 tasks after another start, one robot lay on its back."""
    world = make_world(Event(0.0, {"ball_x": 9.0}))

    def ball_after(milliseconds):
        world.begin()
        world.advance(milliseconds * MS)
        return world.body.state["ball_x"]

    world.reset(start={"x": 1.0})
    assert ball_after(500) == 1.0
    world.reset(start={"x": 1.0}, events=[Event(0.4, {"ball_x": 8.0}), Event(0.2, {"ball_x": 7.0})])
    assert ball_after(100) == 1.0
    world.advance(200 * MS)
    assert ball_after(50) == 7.0
    world.advance(100 * MS)
    assert ball_after(50) == 8.0
    world.reset()
    assert ball_after(50) == 9.0


@pytest.mark.parametrize(
    ("start", "events", "fault"),
    [
        ({"x": 1.0, "bal_x": 2.0}, (), "start of agilo: its body has no bal_x"),
        (
            {},
            (Event(0.0, {"x": 1.0}), Event(0.4, {"bal_x": 2.0, "q": 0.0})),
            "event of agilo: its body has no bal_x, q",
        ),
    ],
)
def test_a_value_that_the_body_does_not_name_is_refused(start, events, fault):
    with pytest.raises(UsageError) as refused:
        World(FakeBody(), start, 3, events)
    assert str(refused.value) == f"{fault} (expected some of: {', '.join(FakeBody().names)})"


@pytest.mark.parametrize(
    ("readings", "returned"), [(None, "None"), ("odom", "'odom'"), ([None], r"\[None\]"), ((3, 4), r"\(3, 4\)")]
)
def test_a_body_that_returns_no_readings_is_named(readings, returned):
    body = FakeBody()
    body.advance = lambda duration_ns: readings
    with pytest.raises(UsageError, match=rf"^advance of the body of .* returned {returned}, expected a list of Read"):
        World(body, {}, 3).advance(STEP_NS)


def test_a_body_may_have_no_readings():
    body = FakeBody()
    body.advance = lambda duration_ns: ()
    assert World(body, {}, 3).advance(STEP_NS) == []


@pytest.mark.parametrize(
    ("topic", "message", "fault"),
    [
        ("odometer", Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0), "a Reading of 'odometer', expected the name of a topic"),
        ("odom", 3.0, "a Reading of odom with 3.0, expected Odometry"),
        ("odom", PoseEstimate(0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0), r"a Reading of odom with PoseE.*, expected Odometry"),
    ],
)
def test_a_reading_that_no_topic_has_is_refused(topic, message, fault):
    world = make_world()
    world.body.advance = lambda duration_ns: [Reading(topic, message, 0)]
    with pytest.raises(UsageError, match=f"^advance of the body of .* returned {fault}$"):
        world.advance(STEP_NS)
