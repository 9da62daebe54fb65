"""A bus whose folder was removed ends, as nobody could stop its robots from a shell any more."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.processes.child import Child, tailor
from tests.support.bus_system import free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.xdist_group("systems")

BEGINNINGS = {("bus",): "routing at ", ("up", "soccer", "--no-scene"): "  approachBall"}


@pytest.fixture
def runtime() -> Iterator[Path]:
    """A folder with a short name: that of a socket has at most 107 bytes."""
    with TemporaryDirectory() as folder:
        yield Path(folder)


@pytest.mark.promise("P45")
@pytest.mark.parametrize("command", BEGINNINGS, ids=" ".join)
def test_a_bus_ends_when_its_folder_was_removed(command, runtime, tmp_path, monkeypatch):
    """The end of a login session removes $XDG_RUNTIME_DIR, also below a bus that runs on in tmux."""
    monkeypatch.delenv("TAILOR_RUN_DIR", raising=False)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(runtime))
    endpoint, log = free_endpoint(), tmp_path / "log"
    with log.open("w") as output:
        child = Child("child", tailor(*command, "--connect", endpoint), output)
    try:
        wait_until(lambda: any(line.startswith(BEGINNINGS[command]) for line in log.read_text().splitlines()))
        shutil.rmtree(runtime / "tailor")
        assert child.wait(PATIENCE_S) == 1
    finally:
        child.kill()
    lost = f"failed: {run_folder(endpoint).path} was removed, so no `tailor estop` reaches the bus; expected"
    assert log.read_text().splitlines()[-1].startswith(lost)
