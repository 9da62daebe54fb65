"""`tailor record` closes its file before its session: that of a router which hangs takes ten seconds to close."""

from __future__ import annotations

import argparse
import sys
from contextlib import contextmanager, nullcontext
from pathlib import Path
from types import SimpleNamespace

import pytest

from tailor.runtime.recordings.recorder import Health
from tailor.schemas.errors import UsageError
from tailor.tools.commands.run import record


def test_the_file_is_whole_before_the_session_is_closed(monkeypatch):
    closed = []

    class Bus:
        queue = requests = None

        def __init__(self, arguments, service):
            pass

        @contextmanager
        def opened(self):
            yield
            closed.append("session")

    class Recorder:
        def close(self):
            closed.append("file")
            return Health()

    monkeypatch.setattr(record, "RecorderBus", Bus)
    monkeypatch.setattr(record, "_recorder", lambda *_, **__: Recorder())
    monkeypatch.setattr(record, "_record", lambda *_, **__: None)
    parser = argparse.ArgumentParser()
    record.configure(parser)
    assert record.run(parser.parse_args(["--quiet"])) == 0
    assert closed == ["file", "session"]


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (["--snapshot", "30", "--max-size", "5"], "--snapshot takes no --max-size "),
        (["--write", "--snapshot", "3"], "--write takes no --snapshot "),
        (["--write", "-o", "a.mcap", "--topics", "odom"], "--write takes no --output, --topics "),
    ],
)
def test_flags_that_the_others_leave_no_use_for_are_refused(words, fault):
    """They were ignored: a recorder that was to begin new files kept seconds in memory."""
    parser = argparse.ArgumentParser()
    record.configure(parser)
    with pytest.raises(UsageError, match=fault):
        record.run(parser.parse_args(words))


@pytest.mark.parametrize(
    ("answer", "code", "line"),
    [
        ((True, "writes run.mcap"), 0, "writes run.mcap"),
        ((False, "nothing to write"), 1, "nothing to write"),
        (
            (False, "no service at recorder/snapshot"),
            2,
            "no service at recorder/snapshot, expected a running `tailor record --snapshot S`",
        ),
    ],
)
def test_a_request_ends_with_1_if_it_is_declined_and_with_2_if_nobody_takes_it(answer, code, line, monkeypatch, capsys):
    monkeypatch.setattr(record, "open_bus", lambda *_, **__: nullcontext(SimpleNamespace(call=lambda *_: answer)))
    monkeypatch.setattr(record, "stop_on_signals", lambda: None)
    monkeypatch.setattr(record, "sender_of", lambda _: "")
    parser = argparse.ArgumentParser()
    record.configure(parser)
    assert record.run(parser.parse_args(["--write"])) == code
    assert "".join(capsys.readouterr()) == f"{line}\n"


@pytest.mark.parametrize("folder", ["", ".", "/"])
def test_a_folder_without_a_name_is_no_recording(folder):
    """Such a path has no name that a number could be appended to: a traceback."""
    parser = argparse.ArgumentParser()
    record.configure(parser)
    with pytest.raises(UsageError, match="is a folder, expected the name of a new file"):
        record._recorder(parser.parse_args(["--output", folder]), None, None, waits_for_room=False)


def test_a_name_that_looks_like_markup_ends_no_recording(monkeypatch):
    """rich reads [/red] as the end of a colour that was never begun; the live line of a terminal ended the recorder."""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(record.time, "sleep", lambda _: setattr(stop, "requested", True))
    stop, steps = SimpleNamespace(requested=False), []
    recorder = SimpleNamespace(health=Health(files=[Path("run[/red].mcap")]), step=steps.append)
    bus = SimpleNamespace(renew=lambda _: None, connected=True, requests=None)
    notifier = SimpleNamespace(alive=lambda: None, status=lambda _: None)
    record._record(recorder, bus, stop, notifier, quiet=False)
    assert len(steps) == 1
