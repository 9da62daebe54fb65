"""Episodes of another source of their robot: training warns of them, and gathering does not go on with them."""

from pathlib import Path

import pytest

from tailor.models.episodes.manifest import write_manifest
from tailor.schemas.errors import UsageError
from tailor.tools.commands.learn import train
from tailor.tools.learning.changed_episodes import changed_episodes_warning
from tailor.tools.learning.gathering.manifests import check_resumable, source_entries
from tailor.tools.learning.training_request import TrainingRequest
from tailor.tools.main import main

BODY = "simnodes/powercube/body.py"
COLUMNS = [{"name": "a", "unit": "rad", "lower": -1.0, "upper": 1.0}]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """Two data sets of the arm, as manifests: of today's source, and of another body."""
    entries = source_entries("arm")
    assert BODY in entries["source_files"]
    other = {"source_sha256": "other", "source_files": {**entries["source_files"], BODY: "0" * 12}}
    for folder, source in (("today", entries), ("before", other)):
        (tmp_path / folder / "reach").mkdir(parents=True)
        about = {"robot": "powercube", "action": "reach", "source": "lock-step, random arguments", **source}
        write_manifest(tmp_path / folder / "reach", {**about, "arguments": COLUMNS, "episodes": 20, "seed": 7})
    return tmp_path


def test_training_warns_of_episodes_that_were_simulated_with_another_body(data, monkeypatch, capsys) -> None:
    """A newcomer changed the body, forgot to gather, and trained: the model of the robot of before was published."""
    monkeypatch.setattr(train, "train_models", lambda request, on_action: [])
    folders = [str(data / "today"), str(data / "before")]
    assert main(["train", "powercube", "--data", *folders, "--zoo", str(data / "zoo")]) == 0
    (warning,) = capsys.readouterr().err.splitlines()
    assert warning.startswith(f"warning: {data / 'before' / 'reach'}: simulated with another {BODY}, expected today's")
    assert "`tailor models check powercube`" in warning


def test_who_names_the_domain_is_told_its_robot(capsys) -> None:
    """`tailor gather soccer` told so, and `tailor train soccer` that data/soccer has no data sets."""
    assert main(["train", "soccer"]) == 2
    assert capsys.readouterr().err.endswith("(agilo is the robot of soccer)\n")


def test_nothing_is_said_of_todays_source_of_recorded_runs_and_of_an_unknown_robot(data: Path) -> None:
    def warning(folder: str, robot: str = "powercube") -> str:
        return changed_episodes_warning(TrainingRequest(robot, data / "zoo", data=(data / folder,)))

    assert warning("today") == ""
    assert warning("before") != ""
    assert warning("before", "elsewhere") == ""
    assert warning("before", "agilo") == ""  # training refuses the arm's episodes
    unstated = {"robot": "powercube", "action": "reach", "source": "lock-step, random arguments", "arguments": COLUMNS}
    write_manifest(data / "before" / "reach", unstated)
    assert warning("before") == ""
    recorded = {"robot": "powercube", "action": "reach", "source": "recordings", "arguments": COLUMNS}
    write_manifest(data / "before" / "reach", {**recorded, "source_sha256": "other"})
    assert warning("before") == ""


def test_a_package_that_cannot_be_parsed_hinders_no_training(data: Path, monkeypatch) -> None:
    def parse(_: str) -> dict[str, str]:
        raise SyntaxError

    monkeypatch.setattr("tailor.tools.learning.changed_episodes.episode_files", parse)
    assert changed_episodes_warning(TrainingRequest("powercube", data / "zoo", data=(data / "before",))) == ""


def test_gathering_that_cannot_go_on_names_the_files_that_changed(data: Path) -> None:
    """It named two hashes of 64 digits, which tell nobody what to do."""
    wanted = {**source_entries("arm"), "episodes": 20}
    check_resumable(data / "today" / "reach", wanted, resume=True)
    with pytest.raises(UsageError) as refused:
        check_resumable(data / "before" / "reach", wanted, resume=True)
    assert str(refused.value) == (
        f"{data / 'before' / 'reach'}: was simulated with another {BODY}, expected today's to resume; "
        "gather anew with another --out, or into an emptied folder"
    )
