"""Active gathering: the optimiser's choices on which the models disagree most, the same bits however interrupted."""

import json
import re
import shutil
from pathlib import Path

import pytest

from tailor.models.episodes.episodes import read_data_set
from tailor.tools.learning.gathering import active_episodes, choosing_models
from tailor.tools.learning.gathering.active_episodes import Active, run_active, selected
from tailor.tools.learning.gathering.refined_choices import Choice
from tailor.tools.main import main

pytestmark = pytest.mark.usefixtures("few_draws")

FLAGS = ["--active", "word-I", "--episodes", "2", "--pool", "2", "--jobs", "1", "--json"]


def choice(name: str, std_s: float) -> Choice:
    return Choice(name, name, (0.0,), std_s)


def test_the_choices_with_the_largest_disagreement_are_selected() -> None:
    pool = [choice("a", 0.1), choice("b", 9.0), choice("a", 0.3), choice("a", 0.2), choice("a", float("nan"))]
    chosen = selected(pool, 2)
    assert [each.std_s for each in chosen["a"]] == [0.3, 0.2]
    assert [each.std_s for each in chosen["b"]] == [9.0]


@pytest.fixture(scope="module")
def gathered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("active")
    assert main(["gather", "powercube", *FLAGS, "--out", str(folder)]) == 0
    return folder


def test_episodes_begin_where_the_optimiser_chose(gathered: Path) -> None:
    pool = [row for path in gathered.glob("pool-*.json") for row in json.loads(path.read_text())]
    data = read_data_set(gathered / "reach")
    assert len(pool) > len(data.episodes) == 2
    largest = sorted(pool, key=lambda row: -row[3])[:2]
    assert [each.arguments.tolist() for each in data.episodes] == [row[2] for row in largest]
    assert all(each.finished and len(each.ticks) > 2 and not each.on_policy for each in data.episodes)
    assert data.manifest["source"].startswith("lock-step, choices with the largest disagreement")


def test_choices_of_another_executive_are_not_mixed_in(gathered: Path, tmp_path: Path, capsys, monkeypatch) -> None:
    """Equal models choose otherwise by other rules of refinement."""
    assert re.fullmatch("[0-9a-f]{64}", read_data_set(gathered / "reach").manifest["runs_sha256"])
    folder = shutil.copytree(gathered, tmp_path / "of-before")
    monkeypatch.setattr(choosing_models, "runs_sha256", lambda domain: "f" * 64)
    assert main(["gather", "powercube", *FLAGS, "--out", str(folder), "--resume"]) == 2
    assert "was gathered with runs_sha256" in capsys.readouterr().err


def test_an_interrupted_run_resumes_to_the_same_bits(gathered: Path, tmp_path: Path, capsys) -> None:
    active = Active("arm", ("word-I",), 2, 2, 7, "", tmp_path)
    steps = run_active(active, 1, resume=False)
    while next(steps).title == "situations refined":
        pass  # the process dies in the midst of the episodes
    steps.close()
    assert main(["gather", "powercube", *FLAGS, "--out", str(tmp_path)]) == 2
    assert "--resume" in capsys.readouterr().err
    assert main(["gather", "powercube", *FLAGS, "--out", str(tmp_path), "--resume"]) == 0
    names = [path.relative_to(gathered) for path in gathered.rglob("*") if path.is_file()]
    assert {str(name) for name in names} >= {"reach/manifest.json", "reach/part-000000.parquet"}
    assert [(tmp_path / name).read_bytes() for name in names] == [(gathered / name).read_bytes() for name in names]


def test_another_pool_is_refused(gathered: Path, capsys) -> None:
    assert main(["gather", "powercube", *FLAGS, "--pool", "3", "--out", str(gathered), "--resume"]) == 2
    assert "situations = 4, expected 6" in capsys.readouterr().err


def test_more_episodes_of_the_same_situations_are_refused(gathered: Path, capsys) -> None:
    """The last part, which was short, would stay short."""
    more = ["--episodes", "4", "--pool", "1"]
    assert main(["gather", "powercube", *FLAGS, *more, "--out", str(gathered), "--resume"]) == 2
    assert "episodes = 2, expected 4 to resume" in capsys.readouterr().err
    data = read_data_set(gathered / "reach")
    assert len(data.episodes) == data.manifest["episodes"] == 2


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0\xff",
        b"[[1]]",
        b"null",
        b'[["reach", "reach", [0.0], null]]',
        b'[["reach", "reach", [0.0], 1.0]]',
        b'[["fly", "fly", [0.0], 1.0]]',
        b'[["reach", "reach", [NaN,0,0,0,0,0,0,0,1,1], 1.0]]',
    ],
)
def test_a_damaged_file_of_choices_is_refused_in_one_line(gathered: Path, tmp_path: Path, capsys, content) -> None:
    shutil.copytree(gathered, tmp_path / "out")
    (pool,) = (tmp_path / "out").glob("pool-*.json")
    pool.write_bytes(content)
    assert main(["gather", "powercube", *FLAGS, "--out", str(tmp_path / "out"), "--resume"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"tailor gather: {pool}: ")
    assert "expected choices of situations (remove it, and --resume refines them again)" in line


def test_seeds_of_situations_are_none_of_other_streams() -> None:
    from tailor.tools.learning.gathering.data_set_spec import (
        EVALUATION_STREAM,
        NOISE_STREAM,
        POLICY_STREAM,
        TRAINING_STREAM,
    )
    from tailor.tools.learning.gathering.policy_runs import FIRST_SEED

    streams = (EVALUATION_STREAM, NOISE_STREAM, POLICY_STREAM, TRAINING_STREAM)
    assert active_episodes.ACTIVE_STREAM not in streams
    assert active_episodes.FIRST_SEED > FIRST_SEED + 100_000 * 1000
