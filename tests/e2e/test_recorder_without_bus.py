"""A recorder reports that its bus disconnected, and continues when it reconnects."""

import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from tailor.runtime.bus.opening import open_local_router, open_router
from tailor.runtime.processes.child import tailor
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.messages import EStop
from tailor.tools.recordings.health_text import DISCONNECTED, RECONNECTED
from tests.support.bus_system import ROOT, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

Lines = Callable[[], list[str]]


@contextmanager
def bereft(
    bus: Callable[[str], AbstractContextManager[object]], endpoint: str, folder: Path
) -> Iterator[tuple[subprocess.Popen[bytes], Lines, Path]]:
    """A recorder that has reported the end of its bus: its process, the lines that it wrote, and its file."""
    path, log = folder / "a.mcap", folder / "log"
    command = tailor("record", "-o", str(path), "--quiet", "--connect", endpoint)

    def lines() -> list[str]:
        return log.read_text().splitlines()

    with bus(endpoint), log.open("w") as stderr:
        recorder = subprocess.Popen(command, stderr=stderr, cwd=ROOT)
        wait_until(lambda: path.exists() or recorder.poll() is not None, "recording")
    try:
        wait_until(lambda: lines() == [DISCONNECTED], "word of the lost bus")
        yield recorder, lines, path
    finally:
        recorder.kill()
        recorder.wait()


def test_a_recorder_reports_that_the_bus_disconnected_and_reconnected(tmp_path):
    endpoint = free_endpoint()
    with bereft(open_router, endpoint, tmp_path) as (recorder, lines, _), open_router(endpoint):
        wait_until(lambda: lines() == [DISCONNECTED, RECONNECTED], "word of the bus that is back")
        recorder.send_signal(signal.SIGINT)
        assert recorder.wait(PATIENCE_S) == 0


def test_a_recorder_continues_with_the_next_run_of_a_bus_whose_passwords_are_new(tmp_path):
    endpoint = free_endpoint()
    with bereft(open_local_router, endpoint, tmp_path) as (recorder, lines, path):
        with open_local_router(endpoint) as (session, _):
            wait_until(lambda: lines() == [DISCONNECTED, RECONNECTED], "word of the next run")
            publisher, begun = session.publisher("estop", ""), path.stat().st_size

            def recorded():
                publisher.publish(EStop(False))
                return path.stat().st_size > begun

            wait_until(recorded, "a message of the next run")
            recorder.send_signal(signal.SIGINT)
            assert recorder.wait(PATIENCE_S) == 0
        assert {message.key for message in open_recording(path).messages()} == {"estop"}
