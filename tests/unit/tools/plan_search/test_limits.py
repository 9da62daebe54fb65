"""Limits of a search from the command line."""

from __future__ import annotations

import itertools

from tailor.tools.plan_search import limits


def test_a_search_that_grows_quickly_ends_within_ten_mb_of_its_limit(monkeypatch) -> None:
    grown = itertools.count(0.0, 0.4 * limits.CHECKS_PER_LOOK)  # as with 2000 goals, between two looks
    monkeypatch.setattr(limits, "memory_mb", lambda: next(grown))
    budget = limits.Limits(limit_mb=60)
    checks = next(n for n in itertools.count(1) if budget.spent())
    assert 60 < 0.4 * checks < 70
    assert budget.reason == "no plan within 60 MB of memory"
