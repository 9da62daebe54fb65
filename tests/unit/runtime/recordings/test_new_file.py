"""Files that tools make from recordings are whole or absent, so that a second attempt finds their name free."""

import errno

import pytest

from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.mcap import sink, writer
from tailor.runtime.recordings.new_file import check_new_file, new_file
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import UsageError
from tailor.tools.commands.look import verify
from tailor.tools.main import main
from tailor.tools.scenes.recorded_scenes import add_scenes
from tests.support.injection.small_disk import small_disk
from tests.unit.runtime.recordings.test_hostile_recordings import GOLDEN
from tests.unit.runtime.recordings.test_mcap_writer import write_tape


@pytest.fixture
def tape(tmp_path):
    return write_tape(tmp_path / "a.mcap")


@pytest.mark.parametrize(
    ("failure", "reported"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), UsageError),
        (UsageError("damage"), UsageError),
        (KeyboardInterrupt(), KeyboardInterrupt),
    ],
)
def test_a_copy_that_fails_halfway_leaves_no_file_and_can_be_repeated(tape, tmp_path, failure, reported):
    target, kept = tmp_path / "b.mcap", iter([True] * 20)

    def keep(*_):
        if next(kept, None) is None:
            raise failure
        return True

    with pytest.raises(reported):
        copy(tape, target, keep, {})
    assert not target.exists()
    assert copy(tape, target, lambda *_: True, {}).kept == 50


@pytest.mark.parametrize("make", [add_scenes, lambda source, target: copy(source, target, lambda *_: True, {})])
def test_a_file_that_existed_before_stays_as_it_is(tape, tmp_path, make):
    target = tmp_path / "b.mcap"
    target.write_text("mine")
    with pytest.raises(UsageError, match="exists already"):
        make(tape, target)
    assert target.read_text() == "mine"
    with pytest.raises(UsageError, match="No such file or directory"):
        make(tape, tmp_path / "absent" / "b.mcap")


def test_an_interrupt_before_the_file_is_opened_removes_no_file_of_before(tmp_path):
    target = tmp_path / "b.mcap"
    target.write_text("mine")
    with pytest.raises(UsageError, match="exists already"), new_file(target):
        raise KeyboardInterrupt
    assert target.read_text() == "mine"


def test_a_copy_with_scenes_on_a_full_disk_leaves_no_file(tape, tmp_path, monkeypatch):
    target = tmp_path / "b.mcap"

    def full(file, data):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(sink.os, "write", full)
        with pytest.raises(UsageError, match="No space left"):
            add_scenes(tape, target)
    assert not target.exists()
    add_scenes(tape, target)
    assert len(list(open_recording(target).messages())) == 50


def test_a_copy_with_scenes_waits_on_the_disk_instead_of_in_memory(tape, tmp_path, monkeypatch):
    monkeypatch.setattr(writer, "STUCK_BYTES", 2000)
    flushes, flush = [], writer.McapWriter.flush
    monkeypatch.setattr(writer.McapWriter, "flush", lambda self: flushes.append(1) or flush(self))
    monkeypatch.setattr(writer, "CHUNK_BYTES", 500)
    add_scenes(tape, tmp_path / "b.mcap")
    assert flushes
    assert len(list(open_recording(tmp_path / "b.mcap").messages())) == 50


def test_outputs_of_a_run_that_cannot_be_verified_leave_no_file(tmp_path, capsys, monkeypatch):
    target = tmp_path / "b.mcap"

    def fails(*_):
        assert target.exists()
        raise UsageError("tick 7 is missing")

    monkeypatch.setattr(verify, "verify", fails)
    for _ in range(2):
        assert main(["verify", str(GOLDEN), "-o", str(target)]) == 2
        assert "tick 7 is missing" in capsys.readouterr().err
        assert not target.exists()


def test_a_file_that_can_be_made_is_not_made_yet_but_its_folder_is(tmp_path):
    check_new_file(tmp_path / "runs" / "b.mcap")
    assert list(tmp_path.rglob("*")) == [tmp_path / "runs"]


@pytest.mark.parametrize(
    ("place", "reason"),
    [
        ("taken", "taken: exists already"),
        ("taken/b.mcap", "taken: exists already"),
        ("/proc/b.mcap", "expected a file"),
    ],
)
def test_a_file_that_cannot_be_made_is_refused(tmp_path, place, reason):
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(UsageError, match=reason):
        check_new_file(tmp_path / place)
    assert (tmp_path / "taken").read_text() == "mine"


def test_a_file_for_which_there_is_no_room_is_refused_and_removed(tmp_path):
    problem = r"b\.mcap: File too large, expected a file that can be written"
    with small_disk(1000), pytest.raises(UsageError, match=problem):
        check_new_file(tmp_path / "b.mcap")
    assert list(tmp_path.iterdir()) == []
