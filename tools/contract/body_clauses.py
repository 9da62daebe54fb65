"""Clauses that concern the simulated body."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from tailor.schemas.topics import TOPICS
from tailor.simnodes.body import STEP_NS, Reading
from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import LOOKING_TICKS, Subject
from tailor.tools.lockstep.action_run import PERIOD_NS

ENOUGH = 0.5  # of the readings that a sensor's rate promises: percepts may be lost


@clause("package", needs="body")
def body_names_its_robot(subject: Subject, case: str) -> Iterator[str]:
    """The body has the robot's name, and scenarios start it with values that it names."""
    if subject.body.robot != subject.spec.robot:
        yield f"robot is '{subject.body.robot}', expected '{subject.spec.robot}' by the spec"
    for scenario in subject.scenarios:
        unknown = sorted(set(subject.scenario(scenario, 0)[1]) - set(subject.body.names))
        yield from (f"{scenario} starts with '{name}', which is none of the body's names" for name in unknown)


@clause("package", needs="body")
def sensors_keep_their_rates(subject: Subject, case: str) -> Iterator[str]:
    """Each required sensor is sensed about as often as its topic's rate says; all readings have their topic's type."""
    readings = _look(subject)
    counts, seconds = Counter(reading.topic for reading in readings), LOOKING_TICKS * PERIOD_NS * 1e-9
    for name in subject.domain.required:
        due = TOPICS[name].rate_hz * seconds
        if not ENOUGH * due <= counts[name] <= due + 1:
            yield f"{name}: {counts[name]} readings in {seconds:g} s, expected {due:g} by its topic's rate"
    for reading in readings:
        if reading.topic not in TOPICS:
            yield f"there is no topic '{reading.topic}'"
            return
        if type(reading.message) is not TOPICS[reading.topic].type:
            yield f"{reading.topic}: a {type(reading.message).__name__}, expected {TOPICS[reading.topic].type.__name__}"
            return


@clause("package", needs="body")
def readings_are_in_order(subject: Subject, case: str) -> Iterator[str]:
    """Readings come in the order of their times, none from the future."""
    times = [reading.time_ns for reading in _look(subject)]
    if times != sorted(times):
        yield "readings are not in the order of their times"
    elif times and times[-1] > LOOKING_TICKS * PERIOD_NS:
        yield f"a reading of {times[-1] * 1e-9:g} s came after {LOOKING_TICKS * PERIOD_NS * 1e-9:g} s"


@clause("package", needs="body")
def body_follows_the_seed(subject: Subject, case: str) -> Iterator[str]:
    """After a reset the body repeats all its readings, noise included, if its generator is the same."""
    _, start = subject.scenario(subject.scenarios[0], 0)
    if subject.look(start, seed=1)[1] != subject.look(start, seed=1)[1]:
        yield "two resets with the same seed give different readings: all noise must come from rng"


@clause("package", needs="body")
def repeated_set_points_change_nothing(subject: Subject, case: str) -> Iterator[str]:
    """A set-point that the node repeats every 10 ms moves the body as one that it receives once."""
    command = tuple(0.3 * axis.upper for axis in subject.domain.axes)
    _, start = subject.scenario(subject.scenarios[0], 0)
    ends = []
    for repeats in (False, True):
        subject.body.reset(np.random.default_rng(2), start)
        for step in range(PERIOD_NS // STEP_NS):
            if repeats or step == 0:
                subject.body.command(command)
            subject.body.advance(STEP_NS)
        ends.append(subject.body.ground_truth())
    if ends[0] != ends[1]:
        yield f"after 0.1 s: {ends[1]}, expected {ends[0]}"


def _look(subject: Subject) -> list[Reading]:
    """What the body senses at the start of the first scenario."""
    _, start = subject.scenario(subject.scenarios[0], 0)
    return subject.look(start)[1]
