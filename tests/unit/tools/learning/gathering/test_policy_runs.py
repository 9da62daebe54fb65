"""Runs of the executive from which models learn."""

from collections import Counter
from pathlib import Path

from tailor.tools.learning.gathering.policy_runs import Policy


def test_every_run_has_a_seed_of_its_own():
    """Scenarios of one seed share noise and what the body draws, so that folds would share worlds."""
    scenarios = ("letter-A", "letter-B", "letter-C")
    jobs = Policy("arm", scenarios, 6, 7, "", Path()).jobs
    assert Counter(scenario for scenario, _ in jobs) == dict.fromkeys(scenarios, 6)
    assert len({seed for _, seed in jobs}) == len(jobs) == 18
    later = Policy("arm", scenarios, 6, 8, "", Path()).jobs
    assert {seed for _, seed in jobs}.isdisjoint(seed for _, seed in later)
