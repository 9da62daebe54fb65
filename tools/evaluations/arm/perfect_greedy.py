"""Greedy by the simulator's own outcome: at each waypoint the velocities with which the reach to it took the least."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive import domains
from tailor.executive.domains.arm.letters import Point
from tailor.executive.interfaces.values import Array
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.tools.lockstep.action_run import TIME_LIMIT_S, run_action

GRID = 5  # velocities of a joint in the first round, from limit to limit
DRAWS = 4  # runs of each choice, with other noise, temperatures and wear: a model cannot know these either
NOISE_STREAM = 41
ARM = domains.load("arm")


@dataclass(frozen=True, slots=True)
class Leg:
    """A reach to choose the end of: joint state at the start, waypoint (rad), largest velocity there (rad/s)."""

    start: tuple[float, float, float, float]  # a, wa, b, wb
    waypoint: Point
    fastest: float
    seed: tuple[int, int]  # of the letter, number of the leg


def greedy_velocities(letter: str, seed: int) -> tuple[Point, ...]:
    """Velocities (rad/s) at all waypoints of a letter but the last, chosen one after the other."""
    scenario, start = domains.seeded_scenario("arm", f"word-{letter}", seed)
    state, body = (start["a"], 0.0, start["b"], 0.0), PowerCubeBody()
    chosen: list[Point] = []
    for number, place in enumerate(list(scenario.places.values())[:-1]):
        leg = Leg(state, (place["a"], place["b"]), place["fastest"], (seed, number))
        wa, wb = _fastest_choice(body, leg)
        chosen.append((wa, wb))
        state = (place["a"], wa, place["b"], wb)
    return tuple(chosen)


def _fastest_choice(body: PowerCubeBody, leg: Leg) -> Point:
    """The choice that took the least on average, on a grid and then on a finer one about the best."""
    steps = np.linspace(-leg.fastest, leg.fastest, GRID)
    best = _best(body, leg, list(itertools.product(steps.tolist(), repeat=2)))
    half = 0.5 * float(steps[1] - steps[0])
    finer = [
        (wa, wb)
        for wa, wb in itertools.product(*([v - half, v, v + half] for v in best))
        if max(abs(wa), abs(wb)) <= leg.fastest + 1e-9
    ]
    return _best(body, leg, finer)


def _best(body: PowerCubeBody, leg: Leg, choices: Sequence[Point]) -> Point:
    """The fastest choice; of several that took the same number of periods the middle one."""
    least_s, tied = np.inf, list[Point]()
    for choice in choices:
        total_s = _total_s(body, leg, choice, least_s)
        if total_s < least_s - 1e-6:
            least_s, tied = total_s, []
        if total_s < least_s + 1e-6:
            tied.append(choice)
    middle = np.mean(tied, axis=0)
    return min(tied, key=lambda choice: float(np.linalg.norm(middle - choice)))


def _total_s(body: PowerCubeBody, leg: Leg, choice: Point, most_s: float) -> float:
    """Sum of the durations of all draws; infinite as soon as it exceeds `most_s`."""
    total_s = 0.0
    for rng in _noise(leg):
        left_s = min(TIME_LIMIT_S, most_s - total_s + 0.2)
        run = run_action(body, ARM, "reach", _arguments(leg, choice), rng, limit_s=left_s)
        total_s += run.duration_s if run.success else np.inf
        if total_s > most_s + 1e-6:
            return np.inf
    return total_s


def _noise(leg: Leg) -> Iterator[np.random.Generator]:
    """The same noise for every choice."""
    return (np.random.default_rng([NOISE_STREAM, *leg.seed, draw]) for draw in range(DRAWS))


def _arguments(leg: Leg, choice: Point) -> Array:
    (a, b), (wa, wb) = leg.waypoint, choice
    return np.array([*leg.start, a, wa, b, wb])
