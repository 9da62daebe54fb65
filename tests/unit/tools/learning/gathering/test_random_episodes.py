"""Gathering: same seed, same bits, however it is spread, interrupted or resumed."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import joblib
import numpy as np
import pytest

from tailor.models.episodes.episodes import merge, read_data_set
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import policy_runs, random_episodes
from tailor.tools.learning.gathering.data_set_spec import EVALUATION_STREAM, DataSetSpec
from tailor.tools.learning.gathering.random_episodes import PART
from tailor.tools.main import main
from tests.support import far_backend

pytestmark = pytest.mark.usefixtures("few_draws")

COUNT = PART + 4


def gather(folder: Path, *more: str, seed: int = 7) -> int:
    settings = ["--episodes", str(COUNT), "--jobs", "1", "--seed", str(seed), "--json"]
    return main(["gather", "agilo", "goToPose", "--out", str(folder), *settings, *more])


@pytest.fixture(scope="module")
def gathered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("gathered")
    assert gather(folder) == 0
    return folder / "goToPose"


def parts(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("part-*"))}


def test_a_killed_run_resumes_to_the_same_bits(gathered: Path, tmp_path: Path) -> None:
    spec = DataSetSpec("soccer", "goToPose", COUNT, 7, tmp_path / "goToPose")
    random_episodes.prepare(spec, resume=False)
    list(random_episodes.gather(spec, [PART], jobs=1))  # the second part; the process dies in the first
    (tmp_path / "goToPose" / "part-000000-000020.1234.tmp").write_bytes(b"half a part")
    assert gather(tmp_path, "--resume") == 0
    assert parts(tmp_path / "goToPose") == parts(gathered)
    assert not list((tmp_path / "goToPose").glob("*.tmp"))


def test_nothing_is_learned_from_a_part_of_what_the_card_would_name(gathered: Path, tmp_path: Path, capsys) -> None:
    """A card's command gathers all episodes, so that it would make another model."""
    data, zoo = tmp_path / "data" / "goToPose", tmp_path / "zoo"
    shutil.copytree(gathered, data)
    (data / f"part-{0:06d}-{PART:06d}.parquet").unlink()
    assert main(["train", "agilo", "--data", str(data.parent), "--zoo", str(zoo)]) == 2
    (line,) = [each for each in capsys.readouterr().err.splitlines() if each.startswith("tailor")]
    assert f"{data}: gathering was interrupted, {PART} of {COUNT} runs are missing, expected all of them: " in line
    assert not zoo.exists()


def test_episodes_of_evaluation_are_never_those_of_training(gathered: Path) -> None:
    spec = DataSetSpec("soccer", "goToPose", 8, 7, gathered)
    evaluation = DataSetSpec("soccer", "goToPose", 8, 7, gathered, stream=EVALUATION_STREAM)
    assert not np.isclose(spec.rng(0).uniform(size=4), evaluation.rng(0).uniform(size=4)).any()


def test_a_data_set_holds_what_happened(gathered: Path) -> None:
    data = read_data_set(gathered)
    assert [episode.number for episode in data.episodes] == list(range(COUNT))
    for episode in data.episodes:
        assert episode.success or episode.failure
        assert abs(len(episode.ticks) * 0.1 - episode.duration_s) < 0.15
        assert np.abs(episode.ticks[0, :2] - episode.arguments[:2]).max() < 0.2
        assert (episode.ticks[:, 4:] == episode.arguments[4:]).all()


def test_the_manifest_says_how_it_was_made(gathered: Path) -> None:
    manifest = read_data_set(gathered).manifest
    assert (manifest["robot"], manifest["action"], manifest["seed"]) == ("agilo", "goToPose", 7)
    assert [argument["name"] for argument in manifest["arguments"]][:4] == ["x", "y", "phi", "v"]
    assert len(manifest["source_sha256"]) == 64


def test_another_profile_of_the_body_gives_other_episodes_of_the_same_tasks(gathered: Path, tmp_path: Path) -> None:
    usual = read_data_set(gathered)
    assert gather(tmp_path, "--profile", "degraded") == 0
    degraded = read_data_set(tmp_path / "goToPose")
    assert (usual.manifest.get("profile"), degraded.manifest["profile"]) == (None, "degraded")
    pairs = list(zip(usual.episodes, degraded.episodes, strict=True))
    assert all(np.array_equal(one.arguments, other.arguments) for one, other in pairs)
    assert all(one.ticks[-1].tolist() != other.ticks[-1].tolist() for one, other in pairs)
    assert len(merge([usual, degraded]).episodes) == 2 * COUNT  # the draw is another one, so they may be merged


def test_gathering_over_other_episodes_is_refused(gathered: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert gather(gathered.parent) == 2
    assert "--resume" in capsys.readouterr().err
    assert gather(gathered.parent, "--resume", seed=8) == 2
    assert "seed = 7, expected 8" in capsys.readouterr().err


def test_a_refused_folder_leaves_no_empty_data_set_of_another_action(gathered: Path, tmp_path: Path, capsys) -> None:
    shutil.copytree(gathered, tmp_path / "goToPose")
    for more in ([], ["--resume", "--seed", "8"]):
        command = ["gather", "agilo", "approachBall", "goToPose", "--episodes", "3", "--out", str(tmp_path), *more]
        assert main(command) == 2
        assert f"{tmp_path}/goToPose: " in capsys.readouterr().err
        assert [path.name for path in tmp_path.iterdir()] == ["goToPose"]


def test_going_on_with_fewer_episodes_throws_none_away(gathered: Path, tmp_path: Path, capsys) -> None:
    """The default of --episodes is small, and easily left out."""
    folder = shutil.copytree(gathered, tmp_path / "goToPose")
    assert gather(tmp_path, "--resume", "--episodes", "3") == 2
    assert f"--episodes is 3, expected at least {COUNT}" in capsys.readouterr().err
    assert parts(folder) == parts(gathered)


def test_parts_whose_manifest_is_gone_pass_for_no_others(gathered: Path, tmp_path: Path, capsys) -> None:
    """Those of another seed, say: some would have been kept as finished ones, the others deleted."""
    folder = shutil.copytree(gathered, tmp_path / "goToPose")
    (folder / "manifest.json").unlink()
    for more in ([], ["--resume"]):
        assert gather(tmp_path, *more, seed=8) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert line.endswith(
            "part-000000-000020.parquet: there is no manifest.json beside it, expected one, or another --out"
        )
        assert parts(folder) == parts(gathered)


def test_runs_whose_data_set_is_gone_do_not_pass_for_finished(tmp_path: Path, capsys) -> None:
    runs = ["gather", "agilo", "--on-policy", "approach", "--out", str(tmp_path), "--jobs", "1", "--episodes", "1"]
    assert main(runs) == 0
    shutil.rmtree(tmp_path / "approachBall")
    for more in ([], ["--resume"]):
        capsys.readouterr()
        assert main([*runs, *more]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert "runs-000000-000001.done: approachBall/manifest.json is not there any more, expected both" in line


def test_an_interrupted_resumption_counts_what_was_there_before(tmp_path: Path, monkeypatch, capsys) -> None:
    def runs(*more: str) -> int:
        words = ["gather", "agilo", "--on-policy", "approach", "--out", str(tmp_path / "[/x]"), "--jobs", "1", *more]
        return main(words)

    assert runs("--episodes", "10") == 0
    capsys.readouterr()

    def interrupted(*_: object) -> Iterator[int]:
        raise KeyboardInterrupt
        yield 0

    monkeypatch.setattr(policy_runs, "_run_missing", interrupted)
    assert runs("--episodes", "12", "--resume", "--json") == 130
    assert capsys.readouterr().err == f"{tmp_path}/[/x]: kept 10 of 12 runs; --resume continues\n"


def test_whole_runs_do_not_overwrite_random_episodes(gathered: Path, capsys) -> None:
    before = (gathered / "manifest.json").read_text()
    into = ["--out", str(gathered.parent), "--episodes", "1", "--jobs", "1", "--json"]
    assert main(["gather", "agilo", "--on-policy", "approach", *into]) == 2
    assert "goToPose: holds episodes already" in capsys.readouterr().err
    assert (gathered / "manifest.json").read_text() == before
    assert not (gathered.parent / "approachBall").exists()


def test_whole_runs_go_on_where_they_stopped_and_only_as_they_began(tmp_path: Path, capsys) -> None:
    def runs(*more: str) -> int:
        words = ["gather", "agilo", "--on-policy", "approach", "--out", str(tmp_path), "--jobs", "1", "--json", *more]
        return main(words)

    assert runs("--episodes", "1") == 0
    assert json.loads(capsys.readouterr().out) == {"folder": str(tmp_path), "runs": 1, "run_now": 1}
    assert runs("--episodes", "2", "--resume") == 0  # a chunk that was shorter grows
    assert len(read_data_set(tmp_path / "approachBall").episodes) == 2
    capsys.readouterr()
    assert runs("--episodes", "2", "--resume") == 0
    assert json.loads(capsys.readouterr().out)["run_now"] == 0
    assert runs("--episodes", "2", "--resume", "--seed", "8") == 2
    assert "with seed = 7, expected 8" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (["r2d2"], "no robot 'r2d2'"),
        (["agilo", "fly"], "no action 'fly'"),
        (["agilo", "--episodes", "0"], "--episodes is 0, expected at least 1"),
        (["agilo", "--episodes", "1000001"], "1000001 random episodes, expected at most 1000000"),
        (["agilo", "--episodes", "9223372036854775807"], "9223372036854775807 random episodes, expected at most"),
        (["agilo", "--episodes", "many"], "--episodes is 'many', expected a whole number"),
        (["agilo", "--jobs", "0"], "--jobs is 0, expected at least 1, or -1 for every core"),
        (["agilo", "--jobs", "100000000"], "--jobs is 100000000, expected at most 1000"),
        (["agilo", "--beside-objects", "3000000000"], "3000000000 objects beside each run, expected at most 10000"),
        (
            ["agilo", "--beside-objects", "9999", "--episodes", "999999"],
            "999999 runs beside 9999 objects each, expected at most 2147483648 episodes in all",
        ),
        (
            ["agilo", "--active", "approach", "--pool", "101"],
            "101000 situations (runs, or episodes × pool), expected at",
        ),
        (["agilo", "--seed", "-1"], "--seed is -1, expected at least 0"),
        (["agilo", "--on-policy", "approach", "--zoo", "nowhere"], "no action models for robot 'agilo' in nowhere"),
        (["agilo", "--from", "nowhere.mcap"], "nowhere.mcap"),
        (["agilo", "--profile", "x"], "no profile 'x' of soccer's body, expected one of: nominal, degraded"),
        (["agilo", "--profile", "degraded", "--from", "a.mcap"], "expected none with --from"),
        (["powercube", "--beside-object"], "no action of arm has a context of objects, expected one to gather beside"),
        (
            ["agilo", "--pool", "4"],
            "--pool counts the situations of --active and tasks of --uncertain, expected none without",
        ),
        (["agilo", "--pool", "2", "--on-policy", "approach"], "--pool counts the situations of --active"),
        (["agilo", "--horizon", "1"], "--horizon is for choices that are executed, expected none without --on-policy"),
        (["agilo", "--horizon", "51", "--on-policy", "approach"], "horizon is 51, expected at most 50"),
        (["agilo", "--calibrates", "--active", "approach"], "--calibrates is for choices of finished models, expected"),
        (
            ["agilo", "--zoo", "x"],
            "--zoo names the models that choose, expected none without --on-policy, --active or --uncertain",
        ),
        (["agilo", "--resume", "--from", "a.mcap"], "--resume is for simulated runs, expected none with --from"),
        (["agilo", "--from", "a.mcap", "--episodes", "9"], "--episodes is for simulated runs, expected none with"),
        (["agilo", "--from", "a.mcap", "--seed", "9"], "--seed is for simulated runs, expected none with --from"),
    ],
)
def test_bad_input_is_told_before_anything_starts(wrong: list[str], message: str, tmp_path: Path, capsys) -> None:
    assert main(["gather", *wrong, "--out", str(tmp_path / "x")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert not (tmp_path / "x").exists()


def test_what_is_not_a_data_set_is_told(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no manifest\.json"):
        read_data_set(tmp_path)
    (tmp_path / "manifest.json").write_text('{"robot": 1}')
    with pytest.raises(UsageError, match="not a manifest"):
        read_data_set(tmp_path)


def test_another_joblib_backend_gives_the_same_bits(gathered: Path, tmp_path: Path) -> None:
    far_backend.register()
    sent = far_backend.FarBackend.sent
    with joblib.parallel_config(far_backend.NAME):
        assert gather(tmp_path, "--jobs", "2") == 0
    assert far_backend.FarBackend.sent == sent + 2  # both parts were made elsewhere
    assert parts(tmp_path / "goToPose") == parts(gathered)


@pytest.mark.slow
def test_two_processes_give_the_bits_of_one(gathered: Path, tmp_path: Path) -> None:
    assert gather(tmp_path, "--jobs", "2") == 0
    assert parts(tmp_path / "goToPose") == parts(gathered)
