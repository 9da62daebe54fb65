"""Copies of the working tree, in which one mutant at a time is applied and tested."""

from __future__ import annotations

import compileall
import os
import py_compile
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tests.mutants.mutant import Mutant

Status = Literal["killed", "survived", "broken", "timed out"]
STATUSES: dict[int, Status] = {0: "survived", 1: "killed"}  # by exit code of pytest; 2: tests cannot be collected
ENVIRONMENT = {"PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
FAILED = "FAILED "  # begins the line of a failed test in pytest's summary


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one run of tests.

    Attributes:
      status: Only a test that fails kills a mutant; a test that cannot be imported or set up is broken.
      by: The first test that failed; the end of the output if no test did.
      seconds: Duration of the run.
    """

    status: Status
    by: str
    seconds: float


class Tree:
    """A copy of the project."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def copy(self, folder: Path) -> Tree:
        """A copy of this copy."""
        return Tree(Path(shutil.copytree(self.folder, folder, symlinks=True)))

    @contextmanager
    def mutated(self, mutant: Mutant) -> Iterator[None]:
        """Apply a mutant inside the block."""
        path = self.folder / mutant.file
        text = path.read_text(encoding="utf-8")
        path.write_text(mutant.mutate(text), encoding="utf-8")
        try:
            yield
        finally:
            path.write_text(text, encoding="utf-8")

    def run(self, tests: Sequence[str], limit_s: float) -> Outcome:
        """Run tests until the first one fails, at most for `limit_s`."""
        options = ("-x", "-q", "-p", "no:cacheprovider", "--tb=no", "-rfE", "-m", "not slow")
        log, began = self.folder.with_suffix(".log"), time.monotonic()
        with log.open("w") as output:
            try:
                done = subprocess.run(
                    [sys.executable, "-m", "pytest", *options, f"--basetemp={self.folder}.tmp", *tests],
                    cwd=self.folder,
                    env=os.environ | ENVIRONMENT | {"PYTHONPATH": str(self.folder / "src")},
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    timeout=limit_s,
                    check=False,
                )
            except subprocess.TimeoutExpired:
                return Outcome("timed out", f"after {limit_s:g} s", limit_s)
            finally:
                self._end_leftovers()
        status, by = _judged(done.returncode, log.read_text().splitlines())
        return Outcome(status, by, time.monotonic() - began)

    def _end_leftovers(self) -> None:
        """End the processes that tests of this copy left behind, as those of a mutant that ends no process do."""
        mark = f"\0PYTHONPATH={self.folder / 'src'}\0".encode()
        for environment in Path("/proc").glob("[0-9]*/environ"):
            with suppress(OSError):  # it has ended, or is another user's
                if mark in b"\0" + environment.read_bytes():
                    os.kill(int(environment.parent.name), signal.SIGKILL)


def copied(root: Path, folder: Path) -> Tree:
    """A copy of the files of the working tree at `root` that git does not ignore, compiled.

    Compiled files carry a hash of their source: a mutant is never mistaken for the original, however fast it comes.

    Raises:
      CalledProcessError: `root` is no working tree of git.
    """
    listed = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    for name in subprocess.run(listed, capture_output=True, text=True, check=True).stdout.split("\0"):
        if name and (root / name).exists():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(root / name, folder / name, follow_symlinks=False)
    mode = py_compile.PycInvalidationMode.CHECKED_HASH
    compileall.compile_dir(folder, quiet=2, invalidation_mode=mode, workers=2)
    return Tree(folder)


def _judged(code: int, lines: Sequence[str]) -> tuple[Status, str]:
    failed = [line.removeprefix(FAILED).split(" - ")[0] for line in lines if line.startswith(FAILED)]
    if code == 1 and not failed:
        return "broken", lines[-1] if lines else ""
    return STATUSES.get(code, "broken"), failed[0] if failed else lines[-1] if lines else ""
