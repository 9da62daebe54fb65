"""Random scales of steps over many orders of magnitude, equal to the last bit on every CPU."""

from __future__ import annotations

import math

import numpy as np

from tailor.executive.interfaces.values import Array

OCTAVES_PER_DECADE = math.log2(10.0)


def random_scales(decades: float, rng: np.random.Generator, shape: int | tuple[int, ...]) -> Array:
    """Numbers from 10**-decades to 1, as many in each octave; within an octave they are drawn along its chord.

    The chord stands for 2**-x, from which it differs by at most 6 %: numpy rounds powers differently on CPUs with
    AVX-512, and the search of a recording would take another way there.

    Args:
      decades: Orders of magnitude below 1, at least 0.
      rng: The only source of randomness.
      shape: Of the numbers.
    """
    octaves = decades * OCTAVES_PER_DECADE * rng.random(shape)
    whole = np.floor(octaves)
    return np.ldexp(1.0 - 0.5 * (octaves - whole), -whole.astype(np.int32))
