"""`--on` a Dask cluster of processes on loopback: the same bits, a killed worker, a lost scheduler, other software."""

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import distributed
import pytest

from tailor.tools.main import main
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.slow
OTHER = "import tailor; tailor.__version__ = '9.9'; "
GATHER = ["gather", "agilo", "goToPose", "--episodes", "100", "--json"]  # five parts


@contextmanager
def started(*words: str, before: str = "") -> Iterator[subprocess.Popen]:
    """A process of `dask scheduler` or `dask worker`."""
    kind, *flags = words
    code = f"{before}from distributed.cli.dask_{kind} import main; main()"
    process = subprocess.Popen([sys.executable, "-c", code, *flags, "--no-dashboard"], stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@pytest.fixture
def scheduler(tmp_path) -> Iterator[tuple[str, subprocess.Popen]]:
    file = tmp_path / "scheduler.json"
    with started("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file)) as process:
        wait_until(lambda: file.exists() and file.read_text().endswith("}"), "scheduler")
        yield json.loads(file.read_text())["address"], process


def worker(address: str, name: str, before: str = ""):
    return started("worker", address, "--nthreads", "1", "--no-nanny", "--name", name, before=before)


def joined(client: distributed.Client, name: str) -> str | None:
    """Address of the worker of that name, if it has joined."""
    workers = client.scheduler_info(n_workers=-1)["workers"]
    return next((address for address, each in workers.items() if each["name"] == name), None)


@contextmanager
def command(*words: str) -> Iterator[subprocess.Popen]:
    call = [sys.executable, "-P", "-m", "tailor.tools.main", *words]
    with subprocess.Popen(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def parts(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((folder / "goToPose").iterdir())}


def test_files_are_those_of_one_process_whoever_is_killed(scheduler, tmp_path, capsys) -> None:
    address, process = scheduler
    assert main([*GATHER, "--jobs", "1", "--out", str(tmp_path / "here")]) == 0
    there = [*GATHER, "--out", str(tmp_path / "there"), "--on", address]
    with worker(address, "first") as first, worker(address, "second"):
        with distributed.Client(address, set_as_default=False) as client:
            killed = wait_until(
                lambda: joined(client, "first") and joined(client, "second") and joined(client, "first")
            )
            with command(*there) as gathering:
                folder = tmp_path / "there" / "goToPose"
                wait_until(lambda: list(folder.glob("*.parquet")), "the first part")
                wait_until(lambda: client.processing(workers=[killed])[killed], "a part on the first worker")
                first.kill()
                wait_until(lambda: len(list(folder.glob("*.parquet"))) >= 3, "a part of the second worker")
                process.kill()
                _, errors = gathering.communicate(timeout=PATIENCE_S)
        assert gathering.returncode == 2
        assert (
            errors
            == f"tailor gather: --on {address}: the scheduler went away; finished parts are kept, --resume continues\n"
        )
    kept = len(list(folder.glob("*.parquet")))
    with started("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2]), worker(address, "third"):
        wait_until(lambda: main([*there, "--resume"]) == 0, "a scheduler and its worker")
    made = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert [each["episodes"] for each in made] == [100 - 20 * kept]
    assert parts(tmp_path / "there") == parts(tmp_path / "here")


def test_evaluations_are_those_of_one_process_and_other_software_is_refused(scheduler, tmp_path, capsys) -> None:
    address, _ = scheduler
    energy = ["evaluate", "energy", "--episodes", "2", "--weights", "0", "1", "--seed", "5", "--json"]
    with worker(address, "ours"), distributed.Client(address, set_as_default=False) as client:
        wait_until(lambda: joined(client, "ours"))
        codes = [main([*energy, "--jobs", "1"]), main([*energy, "--on", address])]
        here, there = [json.loads(text) for text in capsys.readouterr().out.replace("}\n{", "}\0{").split("\0")]
        assert here == there
        assert codes[0] == codes[1]
        with worker(address, "other", before=OTHER):
            other = wait_until(lambda: joined(client, "other"))
            assert main([*GATHER, "--out", str(tmp_path / "x"), "--on", address]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"--on {address}: worker {other}: Tailor is 9.9 (source " in line
    assert not (tmp_path / "x").exists()
