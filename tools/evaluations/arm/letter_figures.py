"""Writes letters in the modes of the evaluation, and measures them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive import domains
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.tools.evaluations.arm.perfect_greedy import greedy_velocities
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach
from tailor.tools.evaluations.costs import NO_COSTS, Costs, costs_of
from tailor.tools.evaluations.progress import tracked
from tailor.tools.learning.gathering.choosing_models import cached_models
from tailor.tools.lockstep.run import Run
from tailor.tools.parallel.pool import completed, in_order
from tailor.tools.writing.measures import rms_jerk, roughness, waypoint_errors_rad
from tailor.tools.writing.writing_mode import WritingMode
from tailor.tools.writing.writing_run import RecordedBody, write
from tailor.tools.writing.writing_track import WritingTrack

ALL_AHEAD = 9  # more actions than a letter has
BASE = RefinementSettings()
GREEDY = replace(BASE, horizon=1)
STOPPING = WritingMode("stopping", BASE, stops=True)
LEARNED_GREEDY = WritingMode("greedy", GREEDY)
REFINED = WritingMode("refined", BASE)
PERFECT_GREEDY = WritingMode("perfect greedy", GREEDY)  # its velocities are given
LEARNED = (STOPPING, LEARNED_GREEDY, REFINED)
ORACLES = (
    WritingMode("oracle, greedy", GREEDY),
    WritingMode("oracle, refined", BASE),
    WritingMode("oracle, all ahead", replace(BASE, horizon=ALL_AHEAD)),
)
Key = tuple[str, int]  # letter, seed


@dataclass(frozen=True, slots=True)
class Figures:
    """Figures of one letter in one mode."""

    achieved: bool
    duration_s: float
    waypoint_mrad: float  # the largest of the letter
    peak_current_a: float
    rms_jerk: float
    roughness: float
    bias_s: float  # predicted minus actual, a reach
    costs: Costs = NO_COSTS


Found = Mapping[str, Mapping[Key, Figures]]  # by mode


def measure_letters(modes: Sequence[WritingMode], keys: Sequence[Key], zoo: str, jobs: int) -> Found:
    """Write every letter in every mode; equal keys have equal starts and noise."""
    wanted = [(mode, key) for key in keys for mode in modes]
    found: dict[str, dict[Key, Figures]] = {mode.name: {} for mode in modes}
    running = completed(_figures, [(mode, key, zoo) for mode, key in wanted], jobs)
    measured = in_order(tracked(running, "letters", len(wanted)))
    for (mode, key), figures in zip(wanted, measured, strict=True):
        found[mode.name][key] = figures
    return found


def _figures(mode: WritingMode, key: Key, zoo: str) -> Figures:
    written, run = _written(mode, *key, zoo)
    if not len(written.arrivals_s):  # it failed on its way to the first waypoint
        return Figures(False, 0.0, math.nan, written.peak_current_a, math.nan, math.nan, math.nan)
    actual_s = np.diff(written.arrivals_s, prepend=0.0)
    return Figures(
        written.result == "achieved",
        written.duration_s,
        1e3 * float(waypoint_errors_rad(written).max()),
        written.peak_current_a,
        rms_jerk(written),
        roughness(written),
        float((written.predicted_s - actual_s).mean() + 0.1),  # an action ends one period before its waypoint
        costs_of(run, domains.load("arm")),
    )


def write_letter(mode: WritingMode, letter: str, seed: int, zoo: str) -> WritingTrack:
    """One letter in one mode."""
    return _written(mode, letter, seed, zoo)[0]


def _written(mode: WritingMode, letter: str, seed: int, zoo: str) -> tuple[WritingTrack, Run]:
    perfect = Models({"reach/duration": PerfectReach()}, {})
    models = perfect if mode in ORACLES else cached_models(RecordedBody.robot, zoo)
    velocities = greedy_velocities(letter, seed) if mode == PERFECT_GREEDY else ()
    return write(letter, mode, models, seed, RecordedBody(), velocities)
