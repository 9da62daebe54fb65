"""Slopes of memory are measured after the settling time, resist outliers, and are not claimed from too little."""

from __future__ import annotations

import numpy as np
import pytest

from tailor.tools.soak.judging.slopes import Growth, growth


def samples(minutes, mb_per_h, start_mb=100.0, noise_mb=0.1, seed=0):
    """One each 5 s; the first ten minutes grow by 50 MB besides."""
    draw = np.random.default_rng(seed)
    times = np.arange(0.0, minutes * 60 + 1, 5.0)
    settling = np.minimum(times / 600, 1.0) * 50
    return [
        (float(at), float(start_mb + warm + at / 3600 * mb_per_h + draw.normal(0, noise_mb)))
        for at, warm in zip(times, settling, strict=True)
    ]


@pytest.mark.parametrize("mb_per_h", [0.0, 0.9, 5.7, -2.0])
def test_the_slope_after_the_settling_time_is_found(mb_per_h):
    measured = growth(samples(40, mb_per_h))
    assert measured.slope == pytest.approx(mb_per_h, abs=0.15)
    assert measured.low <= mb_per_h <= measured.high
    assert measured.flat == (mb_per_h < 1.0)


def test_single_peaks_do_not_change_it():
    rows = samples(40, 0.0)
    rows[300:306] = [(at, mb + 80.0) for at, mb in rows[300:306]]
    assert growth(rows).slope == pytest.approx(0.0, abs=0.15)


def test_a_process_that_did_not_live_long_enough_has_no_slope():
    measured = growth(samples(19.9, 100.0))
    assert measured.slope is None
    assert measured.flat
    assert measured.minutes == pytest.approx(19.9, abs=0.1)


def test_first_and_last_are_kept():
    assert growth([(10.0, 3.0), (70.0, 4.0)]) == Growth(3.0, 4.0, 1.0, None, by_minute_mb=(3.0, 4.0))
