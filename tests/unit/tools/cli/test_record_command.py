"""`tailor record` closes its file before its session: that of a router which hangs takes ten seconds to close."""

from __future__ import annotations

import argparse
from contextlib import contextmanager

from tailor.runtime.recordings.recorder import Health
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
    monkeypatch.setattr(record, "_recorder", lambda *_: Recorder())
    monkeypatch.setattr(record, "_record", lambda *_, **__: None)
    parser = argparse.ArgumentParser()
    record.configure(parser)
    assert record.run(parser.parse_args(["--quiet"])) == 0
    assert closed == ["file", "session"]
