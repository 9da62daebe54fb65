"""Growth of a process's memory: a robust slope with its uncertainty. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from scipy import stats

SETTLING_S = 600.0  # caches fill, chunks and pools reach their size
LEAST_S = 600.0  # of what follows; a slope over less is noise
FLAT_MB_PER_H = 1.0


@dataclass(frozen=True, slots=True)
class Growth:
    """Own memory of one process from its start to its end."""

    first_mb: float
    last_mb: float
    minutes: float
    slope: float | None  # MB/h after the settling time; None: it did not live long enough
    low: float = 0.0  # 95 % confidence interval
    high: float = 0.0
    by_minute_mb: tuple[float, ...] = ()  # medians of each minute, from the start: steps look other than a leak

    @property
    def flat(self) -> bool:
        """Whether it grows by less than the limit; an unmeasured slope is none."""
        return self.slope is None or self.slope < FLAT_MB_PER_H


def growth(samples: Sequence[tuple[float, float]]) -> Growth:
    """Growth from samples (seconds, MB), at least one, in order of time.

    The slope is Theil and Sen's, over the medians of each minute: short peaks and single steps weigh little.
    """
    begin_s, last_s = samples[0][0], samples[-1][0]
    settled = [sample for sample in samples if sample[0] >= begin_s + SETTLING_S]
    measured: tuple[float | None, float, float] = (None, 0.0, 0.0)
    if settled and last_s - settled[0][0] >= LEAST_S:
        measured = _theil_sen(settled)
    sizes = tuple(round(mb, 2) for _, mb in _by_minute(samples))
    return Growth(samples[0][1], samples[-1][1], (last_s - begin_s) / 60, *measured, sizes)


def _theil_sen(samples: Sequence[tuple[float, float]]) -> tuple[float, float, float]:
    """Slope in MB/h, and the bounds of its 95 % confidence interval."""
    hours, sizes = zip(*((at_s / 3600, mb) for at_s, mb in _by_minute(samples)), strict=True)
    result = stats.theilslopes(sizes, hours)
    return float(result[0]), float(result[2]), float(result[3])


def _by_minute(samples: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Medians (seconds, MB) of each minute."""
    minutes = (zip(*rows, strict=True) for _, rows in groupby(samples, key=lambda sample: sample[0] // 60))
    return [(float(np.median(times_s)), float(np.median(sizes_mb))) for times_s, sizes_mb in minutes]
