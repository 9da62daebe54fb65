"""A recorder on a disk that is slow, stalls or is full: its loop never waits, and the file is whole."""

import errno
import os
import threading
import time

import pytest

from tailor.runtime.recordings.mcap import sink
from tailor.runtime.recordings.mcap.sink import SLOW, BackgroundSink
from tailor.runtime.recordings.mcap.writer import McapWriter
from tests.support.patience import wait_until


@pytest.fixture
def disk(monkeypatch):
    """Writes wait until the event is set."""
    ready, real = threading.Event(), os.write

    def write(file, data):
        ready.wait(60.0)
        return real(file, data)

    monkeypatch.setattr(sink.os, "write", write)
    yield ready
    ready.set()


def test_a_flush_does_not_wait_for_a_disk_that_stalls_and_nothing_is_lost(tmp_path, disk):
    file = BackgroundSink(tmp_path / "f")
    began = time.monotonic()
    for number in range(100):
        file.write(b"%03d" % number)
        file.flush()
    assert time.monotonic() - began < 1.0
    assert (file.pending, file.tell(), file.on_disk) == (300, 300, 0)
    disk.set()
    file.finish()
    file.close()
    assert (tmp_path / "f").read_bytes() == b"".join(b"%03d" % number for number in range(100))


def test_a_slow_disk_is_reported_while_it_is_slow(tmp_path, disk, monkeypatch):
    monkeypatch.setattr(sink, "SLOW_S", 0.05)
    writer = McapWriter(tmp_path / "r.mcap", {}, background=True)
    assert writer.flush()
    time.sleep(0.1)
    assert not writer.flush()
    assert writer.disk_error == SLOW
    disk.set()
    wait_until(writer.flush, "disk")
    assert writer.disk_error == ""
    assert writer.close()


def test_a_disk_that_hangs_for_ever_does_not_keep_a_stopped_recorder(tmp_path, disk, monkeypatch):
    monkeypatch.setattr(sink, "FINISH_S", 0.1)
    writer = McapWriter(tmp_path / "r.mcap", {}, background=True)
    writer.flush()
    assert not writer.close()
    assert writer.disk_error == SLOW


class PausedSink(BackgroundSink):
    """Its thread pauses where the bytes are on the disk, and still in the buffer."""

    def __init__(self, path):
        self.reached, self.goes_on, self._bytes = threading.Event(), threading.Event(), 0
        super().__init__(path)

    @property
    def on_disk(self):
        return self._bytes

    @on_disk.setter
    def on_disk(self, value):
        self._bytes = value
        if value:
            self.reached.set()
            assert self.goes_on.wait(60.0)


def test_positions_do_not_depend_on_the_progress_of_the_thread(tmp_path):
    """mcap's index of chunks is made of them."""
    file = PausedSink(tmp_path / "f")
    file.write(b"12345")
    file.flush()
    assert file.reached.wait(60.0)
    file.write(b"67")
    assert (file.tell(), file.pending) == (7, 2)
    file.goes_on.set()
    file.finish()
    file.close()
    assert (tmp_path / "f").read_bytes() == b"1234567"


def test_an_error_appears_with_the_next_flush_and_the_bytes_are_written_again(tmp_path, monkeypatch):
    real = os.write

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(sink.os, "write", full)
    file = BackgroundSink(tmp_path / "f")
    file.write(b"first")
    file.flush()
    with pytest.raises(OSError, match="No space"):
        wait_until(file.flush, "error")
    monkeypatch.setattr(sink.os, "write", real)
    file.write(b"second")
    file.finish()
    file.close()
    assert (tmp_path / "f").read_bytes() == b"firstsecond"


def test_a_flush_whose_remains_cannot_be_cut_off_is_written_over_by_the_next_one(tmp_path, monkeypatch):
    """The file went on behind what had been written of it, so that all later positions in it were wrong."""
    file, real, room = sink.Sink(tmp_path / "f"), os.write, [3]
    file.write(b"first")
    file.flush()

    def broken(*_):
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(sink.os, "write", lambda fd, data: real(fd, data[: room.pop()]) if room else broken())
    monkeypatch.setattr(sink.os, "ftruncate", broken)
    file.write(b"second")
    with pytest.raises(OSError, match="Input/output"):
        file.flush()
    monkeypatch.setattr(sink.os, "write", real)
    file.flush()
    file.close()
    assert (tmp_path / "f").read_bytes() == b"firstsecond"


def test_each_flush_is_passed_on_to_the_disk_at_once(tmp_path, monkeypatch):
    """By itself the kernel keeps it for 30 s, which a power cut would cost."""
    begun = []
    monkeypatch.setattr(sink.os, "posix_fadvise", lambda _, *extent: begun.append(extent))
    file = BackgroundSink(tmp_path / "f")
    for block in (b"first", b"second"):
        file.write(block)
        file.finish()
    file.close()
    assert begun == [(0, 5, os.POSIX_FADV_DONTNEED), (5, 6, os.POSIX_FADV_DONTNEED)]
