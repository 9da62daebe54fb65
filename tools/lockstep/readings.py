"""Readings of a simulated body, as an executive receives them and as a sampler judges them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

from tailor.executive.interfaces.action import Action
from tailor.schemas.messages import Sample
from tailor.schemas.topics import TOPICS
from tailor.simnodes.body import Reading
from tailor.tools.lockstep.task_sampler import TaskSampler


def newest(readings: Sequence[Reading]) -> tuple[Sample, ...]:
    """The newest sensor reading of each topic, as a subscriber of queue depth one receives it."""
    last = {reading.topic: reading for reading in readings}
    return tuple(
        Sample(reading.topic, reading.message, reading.time_ns, 0)
        for reading in sorted(last.values(), key=lambda reading: reading.time_ns)
        if _source(reading.topic) == "driver"
    )


def judged(sampler: TaskSampler, action: Action, start: Mapping[str, float], readings: Sequence[Reading]) -> str:
    """The first failure that the simulator's readings of one tick show, or ""."""
    truths = (reading.message for reading in readings if _source(reading.topic) == "simulator")
    return next((failure for truth in truths if (failure := sampler.failure(action, start, truth))), "")


@lru_cache(maxsize=256)
def _source(topic: str) -> str:
    """Who publishes a topic; looked up for every reading."""
    return TOPICS[topic].source
