"""Situations in which models choose: scenarios in turn, each with a seed of its own."""

from __future__ import annotations

from collections.abc import Sequence

from tailor.schemas.errors import UsageError

MAX_SITUATIONS = 100_000  # of one seed; beyond them begin those of the next one, which is the next round's of a recipe


def situations(scenarios: Sequence[str], origin: int, seed: int, count: int) -> list[tuple[str, int]]:
    """Scenario and seed of each situation.

    Args:
      scenarios: Scenarios, which take turns.
      origin: First seed of all situations of this kind.
      seed: Of the data sets; those of two seeds share no situation.
      count: Number of situations.

    Raises:
      UsageError: The situations would reach those of the next seed.
    """
    if count > MAX_SITUATIONS:
        raise UsageError(too_many(count))
    first = origin + MAX_SITUATIONS * seed
    return [(scenarios[k % len(scenarios)], first + k) for k in range(count)]


def too_many(count: int) -> str:
    """Why data sets of so many situations are refused."""
    expected = f"expected at most {MAX_SITUATIONS}: more would be those of the next seed"
    return f"{count} situations (runs, or episodes × pool), {expected}"
