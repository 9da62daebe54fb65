"""Gathering random episodes of uncertain success: which tasks are run, and that they resume to the same bits."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains
from tailor.models.episodes.episodes import read_data_set
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import uncertain_episodes
from tailor.tools.learning.gathering.data_set_spec import draw
from tailor.tools.learning.gathering.uncertain_episodes import (
    Uncertain,
    judged_actions,
    least_certain,
    run_uncertain,
)
from tailor.tools.main import main

pytestmark = pytest.mark.usefixtures("few_draws")

FLAGS = ["--uncertain", "--episodes", "21", "--pool", "3", "--jobs", "1"]


def test_the_tasks_nearest_to_one_half_are_chosen_whichever_side() -> None:
    probabilities = np.array([0.99, 0.3, np.nan, 0.6, 0.6, 0.01])
    assert least_certain(probabilities, 2) == [3, 4]
    assert least_certain(probabilities, 3) == [1, 3, 4]
    assert least_certain(probabilities, 9) == [0, 1, 3, 4, 5]
    assert least_certain(np.full(5, 0.9), 2) == [0, 1]


@pytest.fixture(scope="module")
def gathered(few_draws, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("uncertain")
    assert main(["gather", "agilo", *FLAGS, "--json", "--out", str(folder)]) == 0
    return folder


def test_the_least_certain_of_all_tasks_are_run_as_they_were_drawn(gathered: Path) -> None:
    data, domain = read_data_set(gathered / "approachBall"), domains.load("soccer")
    spec = Uncertain("soccer", "approachBall", 21, 3, 7, "", gathered / "approachBall").spec
    tasks = np.stack([draw(spec, domain, spec.rng(number)) for number in range(63)])
    doubt = -np.abs(load_model("agilo/approachBall/success").probability(tasks) - 0.5)
    chosen = [episode.number for episode in data.episodes]
    assert chosen == sorted(chosen)
    assert len(chosen) == 21
    assert doubt[chosen].min() >= np.delete(doubt, chosen).max()
    assert [episode.arguments.tolist() for episode in data.episodes] == tasks[chosen].tolist()
    assert all(episode.selected and not episode.on_policy and len(episode.ticks) > 2 for episode in data.episodes)
    assert data.manifest["candidates"] == 63


def test_an_interrupted_run_resumes_to_the_same_bits(gathered: Path, tmp_path: Path, capsys) -> None:
    uncertain = Uncertain("soccer", "approachBall", 21, 3, 7, "", tmp_path / "approachBall")
    steps = run_uncertain([uncertain], 1, resume=False)
    assert [next(steps).done, next(steps).done] == [0, 20]
    steps.close()  # the process dies after the first part
    assert main(["gather", "agilo", *FLAGS, "--out", str(tmp_path)]) == 2
    assert "--resume" in capsys.readouterr().err
    assert main(["gather", "agilo", *FLAGS, "--json", "--out", str(tmp_path), "--resume"]) == 0
    assert json.loads(capsys.readouterr().out)["run_now"] == 1
    names = [path.relative_to(gathered) for path in gathered.rglob("*") if path.is_file()]
    assert len(names) == 3
    assert [(tmp_path / name).read_bytes() for name in names] == [(gathered / name).read_bytes() for name in names]


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--pool", "4"], "candidates = 63, expected 84 to resume"),
        (["--episodes", "63", "--pool", "1"], "episodes = 21, expected 63 to resume"),
        (["--seed", "8"], "seed = 7, expected 8 to resume"),
        (["--episodes", "40000", "--pool", "26"], "1040000 random tasks (episodes × pool), expected at most 1000000"),
    ],
)
def test_other_tasks_are_not_mixed_in(gathered: Path, capsys, flags, message) -> None:
    assert main(["gather", "agilo", *FLAGS, *flags, "--out", str(gathered), "--resume"]) == 2
    assert message in capsys.readouterr().err
    assert len(read_data_set(gathered / "approachBall").episodes) == 21


def test_no_folder_is_made_where_that_of_another_action_is_refused(gathered: Path, tmp_path: Path) -> None:
    free = Uncertain("soccer", "approachBall", 21, 3, 7, "", tmp_path / "approachBall")
    with pytest.raises(UsageError, match="--resume"):
        run_uncertain([free, replace(free, folder=gathered / "approachBall")], 1, resume=False)
    assert not free.folder.exists()


def test_tasks_of_another_model_are_not_mixed_in(gathered: Path, capsys, monkeypatch) -> None:
    model = load_model("agilo/approachBall/success")
    monkeypatch.setattr(uncertain_episodes, "_model", lambda _: (model, "f" * 64))
    assert main(["gather", "agilo", *FLAGS, "--out", str(gathered), "--resume"]) == 2
    assert "was gathered with models_sha256" in capsys.readouterr().err


def test_an_action_that_nothing_predicts_to_fail_is_refused(tmp_path: Path, capsys) -> None:
    assert main(["gather", "agilo", "goToPose", *FLAGS, "--out", str(tmp_path)]) == 2
    assert "action 'goToPose' of soccer has no model of success, expected one" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
    assert judged_actions("soccer") == ["approachBall"]
    with pytest.raises(UsageError, match="no action of arm has a model of success"):
        judged_actions("arm")
