"""Whatever interrupts the publication of a model, either the old pair of model and card loads or the new one."""

import shutil
import signal
import subprocess
import sys
import threading
from itertools import count
from pathlib import Path

import onnx
import pytest

from tailor.models import runtime
from tailor.models.cards.card import card_path, read_card, write_card
from tailor.models.cards.model_files import waiting_path
from tailor.models.export import zoo_writer
from tailor.models.export.zoo_writer import replace_model, write_model
from tailor.schemas.errors import UsageError
from tailor.tools.main import main

SHIPPED = runtime.ZOO / "powercube" / "reach" / "duration.onnx"
NAMES = ["duration.card.json", "duration.onnx"]
KILLED_WRITER = """
import os, signal, sys
from pathlib import Path
from tailor.models.cards.card import read_card
from tailor.models.export.zoo_writer import write_model

zoo, model, card_file = map(Path, sys.argv[1:4])
content, card, last = model.read_bytes(), read_card(card_file), int(sys.argv[4])
steps = 0

def kill(event, arguments):
    global steps
    if event in ("open", "os.rename", "os.remove", "fcntl.flock"):
        steps += 1
        if steps > last:
            os.kill(os.getpid(), signal.SIGKILL)

sys.addaudithook(kill)
write_model(zoo, content, card)
"""


@pytest.fixture(scope="module")
def old() -> tuple[bytes, dict]:
    return SHIPPED.read_bytes(), {**read_card(card_path(SHIPPED)), "command": "old"}


@pytest.fixture(scope="module")
def new(old) -> tuple[bytes, dict]:
    """A model that predicts as the old one does, of other bytes."""
    graph = onnx.load_from_string(old[0])
    graph.doc_string = "new"
    return graph.SerializeToString(), {**old[1], "command": "new"}


@pytest.fixture
def path(tmp_path: Path, old) -> Path:
    """The old pair in a zoo."""
    return write_model(tmp_path / "zoo", *old)


def loaded(path: Path) -> tuple[str, str]:
    """Which model and which card load."""
    model = runtime.load_robot("powercube", path.parents[2])[0]["reach/duration"]
    return onnx.load(path).doc_string or "old", model.card["command"]


def names(path: Path) -> list[str]:
    return sorted(file.name for file in path.parent.iterdir())


@pytest.mark.parametrize("first", [False, True], ids=["replaced", "first"])
def test_a_writer_that_is_killed_at_any_step_leaves_the_old_pair_or_the_new(tmp_path, old, new, first) -> None:
    (tmp_path / "model").write_bytes(new[0])
    write_card(tmp_path / "card", new[1])
    outcomes = []
    for step in count():
        zoo = tmp_path / f"zoo-{step}"
        path = zoo / "powercube" / "reach" / "duration.onnx"
        if not first:
            write_model(zoo, *old)
        command = [sys.executable, "-c", KILLED_WRITER, zoo, tmp_path / "model", tmp_path / "card", str(step)]
        code = subprocess.run(list(map(str, command)), timeout=60).returncode
        if first and not path.exists():
            outcomes.append(None)
        else:
            before = names(path)
            outcomes.append(loaded(path))
            assert names(path) == before, "whoever reads may have no right to write"
        write_model(zoo, *new)
        assert (loaded(path), names(path)) == (("new", "new"), NAMES)
        if code == 0:
            break
        assert code == -signal.SIGKILL
    there = ("old", "old") if not first else None
    assert len(outcomes) > 6
    assert outcomes == sorted(outcomes, key=lambda pair: pair != there)
    assert set(outcomes) == {there, ("new", "new")}


def fill_disk(monkeypatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(zoo_writer, "write_card", full)


def test_a_model_that_cannot_be_written_whole_leaves_the_one_that_was_there(path, new, monkeypatch) -> None:
    fill_disk(monkeypatch)
    with pytest.raises(OSError, match="No space"):
        replace_model(path, *new)
    assert (loaded(path), names(path)) == (("old", "old"), NAMES)


def interrupted(path: Path, new: tuple[bytes, dict], monkeypatch) -> None:
    """Leave what a kill between both renamings leaves."""
    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", replaced_but_no_card)
        patched.setattr(zoo_writer, "_settle", lambda _: None)
        with pytest.raises(InterruptedError):
            replace_model(path, *new)
    assert waiting_path(card_path(path)).exists()


def replaced_but_no_card(self: Path, target: Path) -> None:
    if target.suffix == ".json":
        raise InterruptedError
    self.rename(target)


def test_an_error_between_both_renamings_publishes_the_new_pair(path, new, monkeypatch) -> None:
    fails = iter([True])

    def replace(self: Path, target: Path) -> None:
        if target.suffix == ".json" and next(fails, False):
            raise KeyboardInterrupt
        self.rename(target)

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(KeyboardInterrupt):
        replace_model(path, *new)
    assert (loaded(path), names(path)) == (("new", "new"), NAMES)


def test_a_full_disk_after_a_kill_keeps_the_pair_that_the_kill_left(path, old, new, monkeypatch) -> None:
    interrupted(path, new, monkeypatch)
    fill_disk(monkeypatch)
    with pytest.raises(OSError, match="No space"):
        replace_model(path, *old)
    assert (loaded(path), names(path)) == (("new", "new"), NAMES)


@pytest.mark.parametrize("left", [b"", b'{"format": 1', b"\xff\xfe"])
def test_files_that_were_not_written_whole_are_ignored_and_removed(path, new, left) -> None:
    waiting_path(path).write_bytes(new[0][:100])
    waiting_path(card_path(path)).write_bytes(left)
    assert loaded(path) == ("old", "old")
    replace_model(path, *new)
    assert (loaded(path), names(path)) == (("new", "new"), NAMES)


@pytest.mark.promise("P32")
def test_a_card_that_waits_for_another_model_excuses_no_altered_one(path, new) -> None:
    write_card(waiting_path(card_path(path)), {**new[1], "sha256": "0" * 64})
    path.write_bytes(new[0])
    with pytest.raises(UsageError, match=r"duration.onnx: sha256 is .*, expected .* by its card"):
        runtime.load_model(path)


def test_a_reader_beside_a_writer_finds_a_pair(path, old, new, monkeypatch) -> None:
    """The writer replaces both files after the reader has read the old card."""
    written = []

    def read_slowly(card_file: Path) -> dict:
        card = read_card(card_file)
        if not written:
            written.append(True)
            replace_model(path, *new)
        return card

    monkeypatch.setattr("tailor.models.cards.model_files.read_card", read_slowly)
    assert runtime.load_model(path).card["command"] == "new"


def test_two_writers_take_turns(path, old, new, monkeypatch) -> None:
    began, go_on = threading.Event(), threading.Event()

    def write(card_file: Path, card: dict) -> None:
        if card["command"] == "old":
            began.set()
            assert go_on.wait(20)
        write_card(card_file, card)

    monkeypatch.setattr(zoo_writer, "write_card", write)
    first, second = (threading.Thread(target=replace_model, args=(path, *pair)) for pair in (old, new))
    first.start()
    assert began.wait(20)
    second.start()
    second.join(0.2)
    assert second.is_alive()
    go_on.set()
    first.join(20)
    second.join(20)
    assert (loaded(path), names(path)) == (("new", "new"), NAMES)


def test_an_interrupted_pair_is_listed_and_pushed(path, new, monkeypatch, tmp_path, capsys) -> None:
    card_path(path).unlink()
    interrupted(path, new, monkeypatch)
    zoo = str(path.parents[2])
    assert main(["models", "list", "--zoo", zoo]) == 0
    assert "powercube/reach/duration" in capsys.readouterr().out
    assert main(["models", "push", "powercube", "--zoo", zoo, "--to", f"{tmp_path}/pushed"]) == 0
    shutil.rmtree(zoo)
    assert main(["models", "pull", "--from", f"{tmp_path}/pushed", "--zoo", zoo]) == 0
    assert (loaded(path), names(path)) == (("new", "new"), NAMES)
