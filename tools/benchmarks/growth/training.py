"""Growth of training: CPU time of a fit against the number of episodes."""

from __future__ import annotations

import time
from collections.abc import Iterator

from tailor.models.training import learners
from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.benchmarks.models import examples

TICKS = 20  # training examples of an episode
EPISODES = (1000, 2000, 5000, 10_000, 20_000)


def curves(quick: bool) -> Iterator[Curve]:
    """One tree of the shipped kind."""
    points = [_point(count) for count in (EPISODES[:-2] if quick else EPISODES)]
    yield Curve("fit of a model tree", "episodes", "CPU time, s", points, 1.0)


def _point(episodes: int) -> tuple[float, float]:
    features, seconds, groups = examples(episodes * TICKS)
    began = time.process_time()
    learners.make_learner("duration", "linear", 1).fit(features, seconds, groups=groups)
    return episodes, time.process_time() - began
