"""Calibrating episodes are choices of the models that are trained; of others training warns."""

import shutil
from pathlib import Path

import pytest

from tailor.models.episodes.manifest import read_manifest, write_manifest
from tailor.tools.commands.learn import train
from tailor.tools.learning import other_choosers
from tailor.tools.learning.other_choosers import other_choosers_warning
from tailor.tools.learning.training_request import TrainingRequest
from tailor.tools.learning.training_run import train_models
from tailor.tools.main import main
from tests.unit.tools.learning.test_training_run import written

pytestmark = pytest.mark.usefixtures("few_first_ticks")

CHOSE = "a" * 64  # the models in the zoo, trained on the random episodes


@pytest.fixture
def data(tmp_path: Path, monkeypatch) -> Path:
    """Random episodes, runs in which models that learned from them chose, and these models."""
    written(tmp_path / "random" / "goToPose", 1)
    written(tmp_path / "other" / "goToPose", 3)
    runs = written(tmp_path / "runs" / "goToPose", 2, on_policy=True, calibrates=True, models_sha256=CHOSE)
    monkeypatch.setattr(other_choosers, "models_hash", lambda robot, zoo: CHOSE)
    train_models(request(tmp_path, "random"))
    assert read_manifest(runs)["calibrates"]
    return tmp_path


def request(data: Path, *folders: str, zoo: str = "zoo") -> TrainingRequest:
    return TrainingRequest("agilo", data / zoo, data=tuple(data / each for each in folders), learner="m5")


def test_the_choices_of_the_models_in_the_zoo_calibrate_them_once_and_again(data: Path, monkeypatch) -> None:
    assert other_choosers_warning(request(data, "random", "runs")) == ""
    assert other_choosers_warning(request(data, "random")) == ""
    train_models(request(data, "random", "runs"))
    monkeypatch.setattr(other_choosers, "models_hash", lambda robot, zoo: "b" * 64)  # their intervals are others now
    assert other_choosers_warning(request(data, "random", "runs")) == ""


def test_the_choices_of_models_that_learned_from_other_episodes_are_named(data: Path, monkeypatch, capsys) -> None:
    """They corrected the intervals without a word."""
    monkeypatch.setattr(train, "train_models", lambda request, on_action: [])
    folders = [str(data / each) for each in ("random", "other", "runs")]
    assert main(["train", "agilo", "--data", *folders, "--zoo", str(data / "zoo")]) == 0
    (warning,) = capsys.readouterr().err.splitlines()
    assert warning.startswith(f"warning: {data / 'runs' / 'goToPose'}: models of other episodes chose")


def test_the_choices_of_models_that_are_not_those_in_the_zoo_are_named(data: Path, monkeypatch) -> None:
    monkeypatch.setattr(other_choosers, "models_hash", lambda robot, zoo: "b" * 64)
    assert f": other models chose than those in {data / 'zoo' / 'agilo'}, expected" in other_choosers_warning(
        request(data, "random", "runs")
    )
    assert other_choosers_warning(request(data, "random", "runs", zoo="empty")) == ""  # nothing to compare with


def test_the_choices_of_two_generations_of_models_are_named(data: Path) -> None:
    shutil.copytree(data / "runs", data / "later")
    manifest = read_manifest(data / "later" / "goToPose")
    write_manifest(data / "later" / "goToPose", {**manifest, "models_sha256": "b" * 64})
    two = request(data, "random", "runs", "later", zoo="empty")
    assert ": 2 different models chose, expected" in other_choosers_warning(two)


def test_models_that_cannot_be_loaded_hinder_no_training(data: Path, monkeypatch) -> None:
    def load(robot: str, zoo: str) -> str:
        raise SyntaxError

    monkeypatch.setattr(other_choosers, "models_hash", load)
    assert other_choosers_warning(request(data, "random", "runs")) == ""
