"""Seeds of evaluations, derived from a hash of the source and the models that are evaluated.

Nobody can choose settings, models or code by the starts of an evaluation: every change of them gives other starts.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import dataclass

from tailor.tools.evaluations.outcome import FIRST_SEED
from tailor.tools.learning.fresh_seeds import fresh_seed


@dataclass(frozen=True, slots=True)
class Seeds:
    """First seed of an evaluation, and where it comes from.

    Attributes:
      first: Every start has a seed of its own, from this one up.
      provenance: Entries for the report.
    """

    first: int
    provenance: Mapping[str, str | int | bool]

    def starts(self, count: int) -> range:
        """Seeds of `count` starts."""
        return range(self.first, self.first + count)


def seeds_of(domain: str, arguments: argparse.Namespace) -> Seeds:
    """Seeds of an evaluation.

    Args:
      domain: Name of the domain.
      arguments: `zoo`, the folder of the models or "" for those that ship; `seed`, the first one, or None to derive it.

    Raises:
      UsageError: No such domain, or its models are missing or altered.
    """
    fresh = fresh_seed(domain, arguments.zoo)
    first = FIRST_SEED + fresh.seed if arguments.seed is None else arguments.seed
    hashes: dict[str, str | int | bool] = {"source_sha256": fresh.source_sha256, "models_sha256": fresh.models_sha256}
    return Seeds(first, {"first_seed": first, "seed_derived": arguments.seed is None, **hashes})
