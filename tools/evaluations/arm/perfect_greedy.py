"""Greedy by the simulator's own outcome: at each waypoint the velocities with which the reach to it took the least.

It knows the friction of the gears as they are at the letter's start, from its first reach on.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive import domains
from tailor.executive.domains.arm.letters import Point
from tailor.executive.interfaces.values import Array
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.simnodes.world import World
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach
from tailor.tools.lockstep.action_run import TIME_LIMIT_S, run_action
from tailor.tools.lockstep.samplers.arm import observed_friction

GRID = 9  # velocities of a joint, from limit to limit
SIMULATED = 10  # choices at each waypoint: the best by the controller's rule, which is 0.06 s off
DRAWS = 4  # runs of each choice, with other noise, wear and strength of the motors: a model cannot know these either
HOPELESS_S = 0.4
NOISE_STREAM = 41
ARM = domains.load("arm")
Durations = list[float]  # seconds, of each draw


@dataclass(frozen=True, slots=True)
class Leg:
    """A reach to choose the end of: joint state at the start, waypoint (rad), largest velocity there (rad/s)."""

    start: tuple[float, float, float, float]  # a, wa, b, wb
    waypoint: Point
    fastest: float
    friction: tuple[float, ...]  # of each gear, a multiple of the nominal
    seed: tuple[int, int]  # of the letter, number of the leg


def greedy_velocities(letter: str, seed: int) -> tuple[Point, ...]:
    """Velocities (rad/s) at all waypoints of a letter but the last, chosen one after the other."""
    scenario, start = domains.seeded_scenario("arm", f"word-{letter}", seed)
    state, body = (start["a"], 0.0, start["b"], 0.0), PowerCubeBody()
    World(body, start, seed)  # draws the temperatures and the wear with which this letter is written
    friction = tuple(observed_friction(gear) for gear in body.gears)
    chosen: list[Point] = []
    for number, place in enumerate(list(scenario.places.values())[:-1]):
        leg = Leg(state, (place["a"], place["b"]), place["fastest"], friction, (seed, number))
        wa, wb = _fastest_choice(body, leg)
        chosen.append((wa, wb))
        state = (place["a"], wa, place["b"], wb)
    return tuple(chosen)


def _fastest_choice(body: PowerCubeBody, leg: Leg) -> Point:
    """The choice that took the least: of a grid those that the controller's rule prefers are simulated."""
    speeds = np.linspace(-leg.fastest, leg.fastest, GRID).tolist()
    choices = list(itertools.product(speeds, repeat=2))
    planned_s, _ = PerfectReach().predict(np.array([_arguments(leg, choice) for choice in choices]))
    return _best(body, leg, [choices[k] for k in np.argsort(planned_s, kind="stable")[:SIMULATED]])


def _best(body: PowerCubeBody, leg: Leg, choices: Sequence[Point]) -> Point:
    """The fastest choice; of several that took the same number of periods the middle one. The first if all failed."""
    least, tied = Durations(), list[Point]()
    for choice in choices:  # with a fast one first others end early
        durations = _durations(body, leg, choice, least)
        if not np.isfinite(durations).all():
            continue
        if sum(durations) < sum(least) - 1e-6 or not least:
            least, tied = durations, []
        if sum(durations) < sum(least) + 1e-6:
            tied.append(choice)
    middle = np.mean(tied or choices[:1], axis=0)
    return min(tied or choices[:1], key=lambda choice: float(np.linalg.norm(middle - choice)))


def _durations(body: PowerCubeBody, leg: Leg, choice: Point, least: Durations) -> Durations:
    """Durations of all draws; infinite from where the choice has fallen `HOPELESS_S` behind the best one."""
    durations = Durations()
    for draw, rng in enumerate(_noise(leg)):
        most_s = sum(least[: draw + 1]) + HOPELESS_S - sum(durations) if least else TIME_LIMIT_S
        run = run_action(body, ARM, "reach", _arguments(leg, choice), rng, limit_s=most_s)
        if not run.success:
            return [*durations, *[np.inf] * (DRAWS - draw)]
        durations.append(run.duration_s)
    return durations


def _noise(leg: Leg) -> Iterator[np.random.Generator]:
    """The same noise for every choice."""
    return (np.random.default_rng([NOISE_STREAM, *leg.seed, draw]) for draw in range(DRAWS))


def _arguments(leg: Leg, choice: Point) -> Array:
    (a, b), (wa, wb) = leg.waypoint, choice
    return np.array([*leg.start, a, wa, b, wb, *leg.friction])
