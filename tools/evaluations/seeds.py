"""Seeds of evaluations, derived from a hash of the source and the models that are evaluated.

Nobody can choose settings, models or code by the starts of an evaluation: every change of them gives other starts.
"""

from __future__ import annotations

import argparse
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

from tailor.executive import domains
from tailor.schemas.installed.source import runs_sha256
from tailor.tools.evaluations.outcome import FIRST_SEED
from tailor.tools.learning.run_gathering import models_hash

DIGITS = 7  # of the hash: seeds stay below those of gathered runs


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
    source, models = runs_sha256(domain), models_hash(domains.load(domain).robot, arguments.zoo)
    digest = hashlib.sha256(f"{source} {models}".encode()).hexdigest()
    first = FIRST_SEED + int(digest[:DIGITS], 16) if arguments.seed is None else arguments.seed
    return Seeds(
        first,
        {"first_seed": first, "seed_derived": arguments.seed is None, "source_sha256": source, "models_sha256": models},
    )
