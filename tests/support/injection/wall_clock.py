"""A wall clock that a test steps while processes run: theirs alone, by a library that is preloaded into them."""

import os
import shutil
import struct
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(__file__).with_name("wall_clock.c")


class WallClock:
    """Of the processes that are started with the environment which it sets; files go into `folder`."""

    def __init__(self, folder, monkeypatch):
        compiler = shutil.which("cc")
        if compiler is None:
            pytest.skip("no C compiler")
        library, self._offset = folder / "wall_clock.so", folder / "offset"
        subprocess.run([compiler, "-shared", "-fPIC", "-o", library, SOURCE, "-ldl"], check=True, timeout=60)
        self._offset.write_bytes(bytes(8))
        monkeypatch.setenv("LD_PRELOAD", str(library))
        monkeypatch.setenv("WALL_CLOCK_OFFSET", str(self._offset))

    def step_to(self, seconds):
        """From now on it is that far ahead of the true one; negative: behind."""
        with self._offset.open("r+b") as file:
            os.write(file.fileno(), struct.pack("=q", round(seconds * 1e9)))
