"""Reports of learners state which source, models and seeds they are of, as all other reports do."""

import json

import numpy as np
import pytest

from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.training import learners
from tailor.tools.evaluations.models import fresh
from tailor.tools.evaluations.seeds import FIRST_SEED
from tailor.tools.main import main

KEYS = {"first_seed", "seed_derived", "source_sha256", "models_sha256"}


def drawn(robot: str, action: str, count: int, seed: int, jobs: int, store: object) -> DataSet:
    """Drives whose durations grow with their distances; every fourth fails."""
    rng = np.random.default_rng(count)
    arguments = rng.uniform(-1.0, 1.0, (60, 8))
    distance = np.hypot(*(arguments[:, 4:6] - arguments[:, :2]).T)
    episodes = [
        Episode(k, row, np.tile(row, (8, 1)), 1.0 + way, k % 4 > 0, "" if k % 4 else "late")
        for k, (row, way) in enumerate(zip(arguments, distance.tolist(), strict=True))
    ]
    return DataSet({}, tuple(episodes), "")


@pytest.mark.parametrize("name", ["duration-learners", "failure-learners", "feature-spaces"])
@pytest.mark.parametrize("seed", [None, 5])
def test_a_report_of_learners_states_its_seeds_and_hashes(name, seed, tmp_path, monkeypatch, capsys) -> None:
    for table, kept in (("DURATION_LEARNERS", "linear"), ("SUCCESS_LEARNERS", "tree")):
        monkeypatch.setattr(learners, table, {kept: getattr(learners, table)[kept]})
    monkeypatch.setattr(fresh, "training", drawn)
    monkeypatch.setattr(fresh, "evaluation", drawn)
    main(["evaluate", name, "--json", "--report", str(tmp_path), *([] if seed is None else ["--seed", str(seed)])])
    printed = json.loads(capsys.readouterr().out)
    about = printed["provenance"]
    assert set(about) == KEYS
    assert about["seed_derived"] == (seed is None)
    assert about["first_seed"] == seed if seed is not None else about["first_seed"] >= FIRST_SEED
    assert f"seeds from {about['first_seed']}" in printed["remarks"][-1]
    assert json.loads((tmp_path / f"{name}.json").read_text())["provenance"] == about
