"""Readings that move the belief farther than the world moves: doubted until they have come several times in a row.

A detector takes something else for the ball, or a cup, now and then. Somebody may have moved it as well: then the next
readings agree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tailor.schemas.messages import Sample

REPEATED = 3  # readings of a topic in a row that contradict the belief: the last one is believed


def believed(
    doubted: Mapping[str, int], samples: tuple[Sample, ...], contradicts: Callable[[Sample, tuple[Sample, ...]], bool]
) -> tuple[Mapping[str, int], tuple[Sample, ...]]:
    """How many readings in a row have been doubted by key, and the samples without those that are.

    Args:
      doubted: What it was before them.
      samples: Measurements of the robot's sensors, in order of arrival.
      contradicts: Whether a sample contradicts the belief after those of this tick before it.
    """
    counts, kept = dict(doubted), list[Sample]()
    for sample in samples:
        count = counts.pop(sample.key, 0)
        if count + 1 < REPEATED and contradicts(sample, tuple(kept)):
            counts[sample.key] = count + 1
        else:
            kept.append(sample)
    return counts, tuple(kept)
