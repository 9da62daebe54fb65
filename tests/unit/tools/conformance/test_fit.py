"""The fit check sees every robot that moves otherwise than the models' robot, and no other."""

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.schemas.messages import Odometry
from tailor.simnodes.body import Reading
from tailor.simnodes.guard import Limit
from tailor.simnodes.world import World
from tailor.tools.conformance.bench import Bench, NotPossible
from tailor.tools.conformance.fit import Response, differences, responses
from tailor.tools.conformance.report import Report, advice, markdown
from tailor.tools.conformance.simulated_link import SimulatedLink
from tailor.tools.conformance.suite import verdicts
from tests.support.stand_ins.bad_drivers import SPEC
from tests.support.stand_ins.body import FakeBody

DOMAIN = domains.load("soccer")


class Ramped(FakeBody):
    """Answers late, accelerates as told, and reaches a fraction of the commanded speed."""

    def __init__(self, dead_s=0.1, slope=0.5, gain=1.0):
        self.dead_ns, self.slope, self.gain, self.queue = round(dead_s * 1e9), slope, gain, []
        self.wanted = (0.0, 0.0)

    def command(self, values):
        self.queue.append((self.time_ns + self.dead_ns, values))

    def advance(self, duration_ns):
        readings = []
        while self.queue and self.queue[0][0] <= self.time_ns:
            self.wanted = self.queue.pop(0)[1]
        step = self.slope * duration_ns * 1e-9
        self.v += max(-step, min(step, self.gain * self.wanted[0] - self.v))
        self.omega += max(-4 * step, min(4 * step, self.wanted[1] - self.omega))
        for reading in super().advance(duration_ns):
            message = reading.message
            if isinstance(message, Odometry):
                noisy = message.v + 0.01 * self.rng.standard_normal()
                message = Odometry(message.stamp_ns, message.x, message.y, message.phi, noisy, message.omega)
            readings.append(Reading(reading.topic, message, reading.time_ns))
        return readings

    def reset(self, rng, start):
        super().reset(rng, start)
        self.rng = rng


class Unseen(FakeBody):
    """Shows its pose alone."""

    def advance(self, duration_ns):
        return [reading for reading in super().advance(duration_ns) if reading.topic == "pose"]


def responses_of(seed=0, **robot):
    link = SimulatedLink(World(Ramped(**robot), {}, seed), SPEC)
    return responses(Bench(link, DOMAIN, SPEC, fraction=0.2), 0.3)


@pytest.mark.parametrize(
    ("robot", "found"),
    [
        ({"seed": 3}, []),
        ({"dead_s": 0.12, "slope": 0.55, "gain": 0.97}, []),
        ({"dead_s": 0.4}, ["v answers after", "omega answers after"]),
        ({"slope": 1.0}, ["v accelerates with", "omega accelerates with"]),
        ({"gain": 0.8}, ["v reaches 0.2"]),
        ({"gain": 0.0}, ["v does not follow a step"]),
    ],
)
def test_what_differs_from_the_models_robot_is_found(robot, found):
    misfits = list(differences(responses_of(**robot), responses_of()))
    assert len(misfits) == len(found), misfits
    assert all(misfit.startswith(start) for misfit, start in zip(misfits, found, strict=True)), misfits


def test_a_step_response_has_the_robots_figures():
    v, omega = responses_of(dead_s=0.2, slope=0.5)
    assert (v.axis, v.unit, omega.axis) == ("v", "m/s", "omega")
    assert v.dead_s == pytest.approx(0.2, abs=0.04)
    assert v.slope == pytest.approx(0.5, rel=0.15)
    assert v.speed == pytest.approx(0.27, abs=0.01)


def test_an_axis_that_hardly_goes_back_is_tested_forward():
    for back in (-0.02, 0.0):
        spec = replace(SPEC, limits=(Limit(back, 0.9), SPEC.limits[1]))
        bench = Bench(SimulatedLink(World(Ramped(), {}, 0), spec), DOMAIN, spec, fraction=0.2)
        assert responses(bench, 0.3)[0].commanded == pytest.approx(0.27)
        assert not any(each.faults or each.skipped for each in verdicts(bench, ["moves_as_commanded"]))


def test_a_robot_that_coasts_after_a_stop_takes_no_command():
    bench = Bench(SimulatedLink(World(Ramped(slope=0.2), {}, 0), SPEC), DOMAIN, SPEC, fraction=0.2)
    [verdict] = verdicts(bench, ["stays_stopped"])
    assert (verdict.faults, verdict.skipped) == ((), "")


def test_a_step_that_noise_hides_is_no_misfit_but_not_possible():
    bench = Bench(SimulatedLink(World(Ramped(), {}, 0), SPEC), DOMAIN, SPEC, fraction=0.2)
    with pytest.raises(
        NotPossible, match=r"^v: a step of 0.036 m/s is lost in the noise .*; expected a higher --speed, or --top-speed"
    ):
        responses(bench, 0.04)


@pytest.mark.parametrize(("period_s", "found"), [(0.02, 1), (0.05, 0)])
def test_rises_that_two_measurements_cannot_tell_apart_are_equal(period_s, found):
    real, models = (Response("v", "m/s", 0.27, 0.1, slope, 0.27, period_s) for slope in (1.2, 2.0))
    assert len(list(differences([real], [models]))) == found


def test_the_period_of_a_response_is_that_of_its_sensors():
    mixed_s = 1 / 60  # 50 Hz of odometry and 10 of the truth
    assert [each.period_s for each in responses_of()] == pytest.approx([mixed_s, mixed_s], rel=0.1)


def test_a_robot_that_does_not_move_is_no_misfit_but_not_possible():
    link = SimulatedLink(World(Ramped(), {}, 0), SPEC)
    link.node.driver.unready = "switched off"
    with pytest.raises(NotPossible, match="cannot be armed"):
        responses(Bench(link, DOMAIN, SPEC, fraction=0.2), 0.3)


class Ending:
    """A link to a driver that has ended: nothing more is heard of it."""

    def __init__(self, link):
        self.link, self.ended = link, False

    def __getattr__(self, name):
        return getattr(self.link, name)

    def wait(self, seconds):
        heard = self.link.wait(seconds)
        return [] if self.ended else heard


def test_a_driver_that_has_ended_is_no_misfit_but_not_possible():
    link = Ending(SimulatedLink(World(Ramped(), {}, 0), SPEC))
    bench = Bench(link, DOMAIN, SPEC, fraction=0.2)
    bench.wait(1.0)
    link.ended = True
    bench.wait(2.0)
    with pytest.raises(NotPossible, match="it publishes no state"):
        responses(bench, 0.3)


def test_a_speed_that_no_sensor_shows_is_named():
    link = SimulatedLink(World(Unseen(), {}, 0), SPEC)
    with pytest.raises(NotPossible, match="expected a field or a joint named as one: v, omega"):
        responses(Bench(link, DOMAIN, SPEC, fraction=0.2), 0.3)


def test_a_misfit_comes_with_the_command_that_gathers_anew():
    response = Response("v", "m/s", 0.27, 0.1, 0.5, 0.27)
    report = Report("agilo", "hardware", [], [response], [response], ["v accelerates with 1"])
    assert "tailor gather agilo && tailor train agilo" in advice(report)
    assert "v accelerates with 1" in markdown(report)
    assert not advice(Report("agilo", "hardware", []))


def test_a_comparison_that_was_not_possible_is_reported():
    report = Report("agilo", "hardware", [], not_compared="measurements of v are missing")
    assert "Step responses: not tried: measurements of v are missing" in markdown(report)
