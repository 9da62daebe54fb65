"""Training beside objects: which models there are, and that training and test never share a run."""

import json
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.models.cards.card import read_card
from tailor.models.episodes.episodes import UNOBSERVED, DataSet, Episode, read_data_set, write_part
from tailor.models.episodes.manifest import read_manifest, write_manifest
from tailor.models.features.features import FeatureSpace, quantities
from tailor.models.training import success_training
from tailor.schemas.errors import UsageError
from tailor.schemas.packages.spec import DomainSpec
from tailor.tools.learning import training_run
from tailor.tools.learning.training_request import TrainingRequest, reproduction_command, spaces_by_kind
from tailor.tools.learning.training_run import context_jobs, own_jobs, train_action, train_models
from tests.support import standin

pytestmark = pytest.mark.usefixtures("few_first_ticks")

NAMES = ("x", "y", "phi", "v", "xg", "yg", "phig", "vg", "obstacle_x", "obstacle_y", "obstacle_r")


def beside(runs: int, objects: int, missing: int = 0, noted: bool = True) -> DataSet:
    """A data set of runs with so many episodes each; the first argument names set and run."""
    episodes = [
        Episode(k, row := np.full(len(NAMES), 1000.0 * objects + k // objects), row[None, :], 1.0, True, "")
        for k in range(missing, runs * objects)
    ]
    manifest = {
        "robot": "agilo",
        "action": "goToPose",
        "arguments": [{"name": name} for name in NAMES],
        "context": {"names": list(NAMES[8:]), "failure": "touched opponent"},
        **({"objects": objects} if noted else {}),
    }
    return DataSet(manifest, tuple(episodes), f"{runs} {objects}")


@pytest.mark.parametrize(
    "sets",
    [
        (beside(5, 2), beside(4, 3)),
        (beside(4, 3), beside(5, 2)),
        (beside(6, 4), beside(7, 1, noted=False)),
        (beside(5, 3, missing=2), beside(2, 4)),
    ],
)
def test_episodes_of_one_run_have_a_number_of_their_own_however_many_objects_each_set_has(sets, monkeypatch) -> None:
    learned = []
    monkeypatch.setattr(success_training, "train_success", lambda episodes, *_: learned.extend(episodes))
    ((merged, kind, learner, train, space),) = context_jobs(sets, TrainingRequest("agilo", Path()), Path())
    train(merged.episodes, space, learner, 1)
    assert kind == "clearance"
    runs = {(e.arguments[0], e.number) for e in learned}
    assert len(learned) == sum(len(each.episodes) for each in sets)
    assert len(runs) == len({run for run, _ in runs}) == len({number for _, number in runs})
    assert {number for _, number in runs} == set(range(len(runs)))


@pytest.mark.parametrize(
    ("in_context", "alone", "apart"),
    [(100, 100, True), (99, 100, False), (100, 99, False), (150, 0, False)],
)
def test_intervals_are_apart_only_where_both_sorts_of_episodes_determine_them(in_context, alone, apart) -> None:
    data = beside(in_context + alone, 1, noted=False)
    marked = tuple(replace(episode, in_context=episode.number < in_context) for episode in data.episodes)
    kinds = [kind for kind, *_ in own_jobs(replace(data, episodes=marked), TrainingRequest("agilo", Path("zoo")))]
    assert ("duration_beside" in kinds) == apart
    assert "duration" in kinds


def written(folder: Path, seed: int, late_s: float = 0.0, **entries: object) -> Path:
    """A data set of planar drives, of which every sixth failed."""
    made = enumerate(standin.episodes(150, seed))
    episodes = [Episode(k, t[0], t, d + late_s, k % 6 > 0, "" if k % 6 else "late") for k, (t, d, _) in made]
    folder.mkdir(parents=True)
    write_part(folder / "part-000000.parquet", episodes, NAMES[:8])
    arguments = [{"name": name, "unit": "", "lower": -4, "upper": 4} for name in NAMES[:8]]
    about = {"robot": "agilo", "action": "goToPose", "arguments": arguments, "seed": seed, **entries}
    write_manifest(folder, about)
    return folder


def test_columns_in_another_unit_than_features_take_are_refused(tmp_path) -> None:
    """Trained on millimetres, a model errs no more than on metres, until the executive asks it in metres."""
    folder = written(tmp_path / "goToPose", 1)
    declared = read_manifest(folder)
    write_manifest(folder, {**declared, "arguments": [{**each, "unit": "mm"} for each in declared["arguments"]]})
    expected = r"goToPose: x is in 'mm', expected 'm' by features 'projective'"
    with pytest.raises(UsageError, match=expected):
        list(train_action([folder], TrainingRequest("agilo", tmp_path / "zoo")))
    assert not (tmp_path / "zoo").exists()


@pytest.mark.parametrize(
    ("column", "factor", "message"),
    [
        (2, 180 / np.pi, r"phi is far outside of -4 to 4 in 1\d\d of 150 episodes, expected numbers in the unit and"),
        (0, 1000.0, "x is far outside of -4 to 4 in 1"),
        (None, 1 / 60, "duration_s is less than half of the ticks last in 150 of 150 episodes, expected seconds"),
    ],
)
def test_columns_that_seem_to_be_in_another_unit_are_refused(column, factor, message, tmp_path) -> None:
    """The manifest states radians, and a converter wrote degrees: the model's own test would not show it."""
    folder, rng = written(tmp_path / "goToPose", 1), np.random.default_rng(1)
    data = read_data_set(folder)
    scale = np.where(np.arange(8) == column, factor, 1.0)
    changed = [
        replace(each, arguments=row, ticks=np.tile(row, (40, 1)), duration_s=4.0 * (factor if column is None else 1.0))
        for each, row in zip(data.episodes, rng.uniform(-3, 3, (150, 8)) * scale, strict=True)
    ]
    write_part(folder / "part-000000.parquet", changed, NAMES[:8])
    with pytest.raises(UsageError, match=f"goToPose: {message}"):
        list(train_action([folder], TrainingRequest("agilo", tmp_path / "zoo")))


def test_no_duration_is_learned_from_episodes_that_calibrate_and_cards_count_them(tmp_path) -> None:
    own, calibrating = written(tmp_path / "a", 1), written(tmp_path / "b", 2, 3.0, on_policy=True, calibrates=True)
    request = TrainingRequest("agilo", tmp_path, learner="linear", failure_learner="tree", seed=3)
    tests = {}
    for zoo, folders in (("alone", [own]), ("both", [own, calibrating])):
        rows = train_action(folders, replace(request, zoo=tmp_path / zoo))
        tests[zoo] = {row["kind"]: row for row in rows}
    errors = [tests[zoo]["duration"]["mae_s"] for zoo in tests]
    assert errors[0] == errors[1]
    assert tests["both"]["duration"]["intervals"] != tests["alone"]["duration"]["intervals"]
    assert tests["both"]["success"]["n"] == pytest.approx(2 * tests["alone"]["success"]["n"], abs=1)
    card = read_card(tmp_path / "both" / "agilo" / "goToPose" / "duration.card.json")["episodes"]
    assert (card["count"], card["calibrates"], [s.get("calibrates") for s in card["sources"]]) == (
        300,
        150,
        [None, True],
    )
    with pytest.raises(UsageError, match="b: 0 finished episodes, expected at least 40"):
        list(train_action([calibrating], request))


@pytest.mark.parametrize(
    ("entries", "flags"),
    [
        ({}, "goToPose --episodes 5 --seed 3"),
        ({"profile": "degraded"}, "goToPose --episodes 5 --seed 3 --profile degraded"),
        ({"objects": 4}, "goToPose --beside-objects 4 --episodes 5 --seed 3"),
        ({"context": {"names": ["r"]}}, "goToPose --beside-object --episodes 5 --seed 3"),
        ({"scenarios": ["a", "b"], "on_policy": True}, "--on-policy a b --episodes 5 --seed 3"),
        ({"scenarios": ["a"], "horizon": 1, "on_policy": True}, "--on-policy a --horizon 1 --episodes 5 --seed 3"),
        (
            {"scenarios": ["a"], "on_policy": True, "calibrates": True},
            "--on-policy a --calibrates --episodes 5 --seed 3",
        ),
        ({"candidates": 150}, "goToPose --uncertain --pool 30 --episodes 5 --seed 3"),
        ({"scenarios": ["a"], "situations": 20}, "--active a --pool 4 --episodes 5 --seed 3"),
    ],
)
def test_a_card_names_the_command_that_gathered_its_episodes(entries, flags) -> None:
    request, folder = TrainingRequest("agilo", Path()), Path("data/agilo/goToPose")
    manifest = {"action": "goToPose", "episodes": 5, "seed": 3, **entries}
    command = reproduction_command(request, spaces_by_kind(request, NAMES[:8], folder), {folder: manifest})
    assert command.startswith(f"tailor gather agilo {flags} --out data/agilo && tailor train agilo goToPose ")


@pytest.mark.parametrize(
    ("robot", "data", "message"),
    [
        ("agilo", ["own", "typo"], "typo: no data sets, expected ACTION/manifest.json (`tailor gather` makes them)"),
        ("b21", ["own"], "own/goToPose: episodes of robot 'agilo', expected 'b21'"),
        ("../../b21", ["own"], "own/goToPose: episodes of robot 'agilo', expected '../../b21'"),
        (
            "agilo",
            ["own", "copied"],
            "copied/goToPose-old: episodes of action 'goToPose', expected 'goToPose-old' by its name",
        ),
        (
            "agilo",
            ["own", "own"],
            "own/goToPose, own/goToPose: two data sets hold the same episodes of goToPose (seed 1), expected each once",
        ),
    ],
)
def test_data_of_something_else_is_refused_before_anything_is_written(tmp_path, monkeypatch, robot, data, message):
    monkeypatch.chdir(tmp_path)
    written(Path("own/goToPose"), 1)
    written(Path("copied/goToPose-old"), 2)
    request = TrainingRequest(robot, Path("zoo/of/mine"), data=tuple(map(Path, data)), learner="linear")
    before = set(tmp_path.rglob("*"))
    with pytest.raises(UsageError) as caught:
        train_models(request)
    assert str(caught.value) == message
    assert {path for path in set(tmp_path.rglob("*")) - before if path.name != "agilo"} <= {
        tmp_path / "zoo", tmp_path / "zoo/of", tmp_path / "zoo/of/mine"
    }  # fmt: skip


NEGATIVE_ROOT = lambda rows, ops: ops.sqrt(-1.0 - rows[[0]] * rows[[0]])  # noqa: E731
SPACES = (FeatureSpace("sine", quantities("x:m"), quantities("x:m"), lambda rows, ops: np.sin(rows)),)


def test_a_space_that_cannot_be_exported_is_refused_before_training(tmp_path, monkeypatch):
    written(tmp_path / "goToPose", 1)
    mine = DomainSpec("soccer", "agilo", "m:f", features=f"{__name__}:SPACES")
    monkeypatch.setattr(training_run, "spec_of_robot", lambda robot: mine)
    monkeypatch.setattr(training_run, "train_action", lambda *_: pytest.fail("trained"))
    with pytest.raises(UsageError, match=r"domain soccer: features = .*feature space 'sine' cannot be exported"):
        train_models(TrainingRequest("agilo", tmp_path / "zoo", data=(tmp_path,), learner="linear"))


def test_a_feature_that_is_not_finite_is_refused_before_training(tmp_path, monkeypatch):
    written(tmp_path / "goToPose", 1)
    root = FeatureSpace(
        "root", quantities(" ".join(f"{name}:m" for name in NAMES[:8])), quantities("r:m"), NEGATIVE_ROOT
    )
    monkeypatch.setattr(training_run, "spaces_by_kind", lambda *_: {"duration": root})
    with pytest.raises(
        UsageError, match=r"goToPose: feature space 'root': r is nan in episode 0, expected a number; x = "
    ):
        train_models(TrainingRequest("agilo", tmp_path / "zoo", data=(tmp_path,), learner="linear"))


@pytest.mark.parametrize(
    ("entries", "part", "message"),
    [
        (
            {"arguments": [{"name": "x", "unit": "m", "lower": 0, "upper": 1}]},
            True,
            "turn: arguments are x, expected x y",
        ),
        ({}, False, "turn: 0 finished episodes, expected at least 40"),
    ],
)
def test_data_of_a_later_action_is_refused_before_a_model_is_replaced(entries, part, message, tmp_path, monkeypatch):
    """The models of the first action were replaced, and the zoo was left with some of both trainings."""
    written(tmp_path / "goToPose", 1)
    written(tmp_path / "turn", 2, action="turn", **entries)
    if not part:
        (tmp_path / "turn" / "part-000000.parquet").unlink()
    monkeypatch.setattr(training_run, "_publish", lambda *_: pytest.fail("written"))
    with pytest.raises(UsageError) as caught:
        train_models(TrainingRequest("agilo", tmp_path / "zoo", data=(tmp_path,), learner="linear"))
    assert str(caught.value).startswith(f"{tmp_path}/{message}")


def test_a_card_names_no_gathering_of_episodes_that_others_wrote() -> None:
    """A converter's manifest has no seed: the card named `tailor gather … --episodes None --seed None`."""
    request, folder = TrainingRequest("agilo", Path()), Path("data/agilo/goToPose")
    command = reproduction_command(
        request, spaces_by_kind(request, NAMES[:8], folder), {folder: {"action": "goToPose"}}
    )
    assert command.startswith("tailor train agilo goToPose ")


def test_a_copy_beside_the_data_set_of_a_named_action_does_no_harm(tmp_path: Path) -> None:
    written(tmp_path / "goToPose", 1)
    written(tmp_path / "goToPose-old", 2)
    request = TrainingRequest("agilo", tmp_path / "zoo", ("goToPose",), (tmp_path,), learner="linear")
    rows = train_models(replace(request, kinds=("duration",)))
    assert [(row["action"], row["kind"]) for row in rows] == [("goToPose", "duration")]


def test_nothing_is_learned_of_success_where_no_episode_was_observed() -> None:
    """Recordings without ground truth: approaches name a model of success, and only durations can be learned."""
    data = beside(50, 1, noted=False)
    data = replace(data, manifest={**data.manifest, "action": "approachBall"})
    unseen = tuple(replace(episode, failure=UNOBSERVED) for episode in data.episodes)
    request = TrainingRequest("agilo", Path("zoo"))
    assert [kind for kind, *_ in own_jobs(data, request)] == ["duration", "success"]
    assert [kind for kind, *_ in own_jobs(replace(data, episodes=unseen), request)] == ["duration"]


def test_a_model_that_fails_its_own_checks_does_not_replace_the_former_one(tmp_path: Path, monkeypatch) -> None:
    folder, zoo = written(tmp_path / "goToPose", 1), tmp_path / "zoo"
    request = TrainingRequest("agilo", zoo, learner="linear", kinds=("duration",))
    list(train_action([folder], request))
    former = {path: path.read_bytes() for path in zoo.rglob("duration*")}
    publishing = training_run._publish

    def published(request, data, *others) -> None:
        files = {data.manifest["source_sha256"]: {"a.py": 5}}  # no hash, put there behind the check of the manifest
        publishing(request, replace(data, manifest={**data.manifest, "source_files": files}), *others)

    monkeypatch.setattr(training_run, "_publish", published)
    manifest = json.loads((folder / "manifest.json").read_text())
    write_manifest(folder, {**manifest, "source_sha256": "x"})
    with pytest.raises(UsageError) as caught:
        list(train_action([folder], replace(request, seed=5)))
    card = zoo / "agilo" / "goToPose" / "duration.card.json"
    assert str(caught.value).startswith(f"{card}: card's episodes' source_files are")
    assert str(caught.value).endswith("such a model is not written, what was there stays")
    assert {path: path.read_bytes() for path in zoo.rglob("*duration*")} == former


def test_the_command_in_a_card_is_one_for_a_shell_also_where_names_have_blanks() -> None:
    folder = Path("my data/goToPose")
    request = TrainingRequest("agilo", Path(), data=(folder.parent,))
    manifest = {"action": "goToPose", "recordings": ["a b.mcap", "c.mcap"]}
    command = reproduction_command(request, spaces_by_kind(request, NAMES[:8], folder), {folder: manifest})
    gathering, training = command.split(" && ")
    assert shlex.split(gathering) == [
        "tailor", "gather", "agilo", "--from", "a b.mcap", "c.mcap", "--out", "my data"
    ]  # fmt: skip
    assert shlex.split(training)[3:6] == ["goToPose", "--data", "my data"]
