"""Seeds derived from a hash of source and models: nobody can choose either by what such a seed draws."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

from tailor.executive import domains
from tailor.schemas.installed.source import runs_sha256
from tailor.tools.learning.gathering.choosing_models import models_hash

DIGITS = 7  # of the hash: below 2^28


@dataclass(frozen=True, slots=True)
class FreshSeed:
    """A seed from 0 to 2^28 - 1, and the hashes that it is derived from."""

    seed: int
    source_sha256: str
    models_sha256: str


def fresh_seed(domain: str, zoo: str = "") -> FreshSeed:
    """Seed for a domain with the models of a zoo; empty: those that ship.

    Raises:
      UsageError: No such domain, or its models are missing or altered.
    """
    source, models = runs_sha256(domain), models_hash(domains.load(domain).robot, zoo)
    return FreshSeed(int(hashlib.sha256(f"{source} {models}".encode()).hexdigest()[:DIGITS], 16), source, models)
