"""Whether episodes can be in the units that their manifest declares: degrees would pass for radians by their name.

A model of such a data set errs no more than another in its own test, until the executive asks it in radians.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tailor.models.episodes.episodes import TICK_S, DataSet

MOST = 0.5  # of the episodes: a few may begin far out, and a data set is in one unit


def implausible(data: DataSet) -> str:
    """What most episodes of a data set contradict, in words with names, numbers and units; empty if nothing.

    An argument is far out beyond its range by the width of that: angles may have one turn more. Ticks come every
    TICK_S, so an episode that lasts less than half of its own has durations in another unit.
    """
    return next(_found(data), "") if data.episodes else ""


def _found(data: DataSet) -> Iterator[str]:
    rows, count = np.stack([episode.arguments for episode in data.episodes]), len(data.episodes)
    for column, declared in zip(rows.T, data.manifest["arguments"], strict=True):
        lower, upper = declared["lower"], declared["upper"]
        far = int(np.sum(np.maximum(lower - column, column - upper) > upper - lower))
        if upper > lower and far > MOST * count:
            about = f"{declared['name']} is far outside of {lower:g} to {upper:g} {declared['unit']}".rstrip()
            yield f"{about} in {far} of {count} episodes, expected numbers in the unit and the range of the manifest"
    short = sum(episode.duration_s < TICK_S * (len(episode.ticks) - 1) / 2 for episode in data.episodes)
    if short > MOST * count:
        yield f"duration_s is less than half of the ticks last in {short} of {count} episodes, expected seconds"
