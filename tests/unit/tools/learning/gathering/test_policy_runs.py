"""Runs of the executive from which models learn."""

import re
import shutil
from collections import Counter
from pathlib import Path

import pytest

from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering.active_episodes import Active
from tailor.tools.learning.gathering.manifests import unfinished
from tailor.tools.learning.gathering.policy_runs import Policy, run_policy


def test_every_run_has_a_seed_of_its_own():
    """Scenarios of one seed share noise and what the body draws, so that folds would share worlds."""
    scenarios = ("letter-A", "letter-B", "letter-C")
    jobs = Policy("arm", scenarios, 6, 7, "", Path()).jobs
    assert Counter(scenario for scenario, _ in jobs) == dict.fromkeys(scenarios, 6)
    assert len({seed for _, seed in jobs}) == len(jobs) == 18
    later = Policy("arm", scenarios, 6, 8, "", Path()).jobs
    assert {seed for _, seed in jobs}.isdisjoint(seed for _, seed in later)


def test_situations_of_two_seeds_never_meet():
    """The rounds of a recipe have one seed after another."""
    scenarios = ("letter-A", "letter-B")
    runs = [Policy("arm", scenarios, 50_000, seed, "", Path()).jobs for seed in (7, 8)]
    choices = [Active("arm", scenarios, 25_000, 4, seed, "", Path()).situations for seed in (7, 8)]
    for earlier, later in (runs, choices):
        assert len(earlier) == 100_000
        assert earlier[-1][1] + 1 == later[0][1]


@pytest.mark.parametrize(
    "drawn",
    [
        lambda: Policy("arm", ("letter-A",), 100_001, 7, "", Path()).jobs,
        lambda: Active("arm", ("letter-A",), 30_000, 4, 7, "", Path()).situations,
    ],
)
def test_more_situations_than_lie_between_two_seeds_are_refused(drawn):
    with pytest.raises(UsageError, match=r"1[02]000[01] situations .*expected at most 100000: more would be those of"):
        drawn()


def test_a_missing_model_is_noticed_before_any_folder_is_made(tmp_path):
    """The first run would need it. By then manifests name the models that choose, and refuse better ones."""
    zoo, out = tmp_path / "zoo", tmp_path / "data"
    shutil.copytree(ZOO / "agilo", zoo / "agilo", ignore=shutil.ignore_patterns("clearance.*"))
    missing = rf"{re.escape(str(zoo))}: action goToPose needs the model goToPose/clearance, expected one of those"
    with pytest.raises(UsageError, match=missing):
        run_policy(Policy("soccer", ("approach",), 1, 7, str(zoo), out), 1)
    assert not out.exists()


@pytest.mark.parametrize(
    ("markers", "missing"),
    [
        (["runs-000000-000010.done", "runs-000010-000016.done"], ""),
        (["runs-000010-000016.done"], "10 of 16 runs"),
        (["runs-000000-000006.done", "runs-000000-000010.done"], "6 of 16 runs"),  # first six, then more were asked for
        ([], ""),  # pulled from a hub: nothing tells
    ],
)
def test_runs_that_an_interruption_left_are_told_by_their_markers(markers, missing, tmp_path):
    (tmp_path / "reach").mkdir()
    for name in markers:
        (tmp_path / name).touch()
    (tmp_path / "reach" / "part-000000.parquet").touch()
    assert unfinished(tmp_path / "reach", {"runs": 16, "on_policy": True}) == missing
