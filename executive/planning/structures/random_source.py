"""Random draws from a seed; numpy, which takes a tenth of a second to load, is loaded at the first draw."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np


class RandomSource:
    """The generator of one search."""

    def __init__(self, seed: int) -> None:
        self._seed = seed

    @cached_property
    def generator(self) -> np.random.Generator:
        """Made at the first use: most searches draw nothing."""
        import numpy as np

        return np.random.default_rng(self._seed)
