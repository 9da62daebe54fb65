"""A fresh virtual environment with the wheel of this checkout, without network.

It sees the third-party packages of the test environment through a .pth file.
"""

import os
import shlex
import shutil
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path

from tests.support.bus_system import ROOT

LINKS = ("executive", "models", "robots", "runtime", "schemas", "simnodes", "tools")
BUILD = "import sys; from setuptools import build_meta; print(getattr(build_meta, sys.argv[1])(sys.argv[2]))"
LIMIT_S = 300.0  # of a build or an installation; they take seconds
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.egg-info")
INSTALL = ("install", "--quiet", "--no-deps", "--no-index", "--no-compile", "--disable-pip-version-check")


def copied_source(copy: Path) -> Path:
    """A copy of the sources, so that the checkout gets no build folder."""
    for name in (*LINKS, "src"):
        shutil.copytree(ROOT / name, copy / name, symlinks=True, ignore=LEFT_OUT)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, copy)
    return copy


def built(kind: str, source: Path, out: Path) -> Path:
    """The file that one of setuptools' build functions makes of a source tree."""
    command = [sys.executable, "-c", BUILD, kind, out]
    done = subprocess.run(command, cwd=source, capture_output=True, text=True, timeout=LIMIT_S)
    assert done.returncode == 0, done.stderr
    return out / done.stdout.split()[-1]


@dataclass
class Environment:
    """A virtual environment in a folder."""

    folder: Path

    @classmethod
    def made(cls, folder: Path, wheel: Path) -> "Environment":
        """A new one that has the wheel."""
        venv.create(folder, with_pip=False)
        made = cls(folder)
        made.install(wheel)
        [site] = folder.glob("lib/python*/site-packages")
        others = [entry for entry in sys.path if entry.endswith(("site-packages", "dist-packages"))]
        (site / "third_party.pth").write_text("".join(f"{entry}\n" for entry in others))
        pytest = made.program("pytest")  # third-party programs belong to the test environment
        pytest.write_text(f'#!/bin/sh\nexec "{made.program("python")}" -m pytest "$@"\n')
        pytest.chmod(0o755)
        return made

    def install(self, *what: str | Path) -> None:
        """`pip install`."""
        subprocess.run(self._pip(*what), check=True, timeout=LIMIT_S)

    def pip_command(self, *what: str | Path) -> str:
        """`install` as a line of a shell script."""
        return shlex.join(map(str, self._pip(*what)))

    def _pip(self, *what: str | Path) -> list[str | Path]:
        return [sys.executable, "-m", "pip", "--python", self.program("python"), *INSTALL, *what]

    def variables(self, **more: str) -> dict[str, str]:
        """Environment variables of its processes; its programs come first on the path."""
        kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        return kept | {"PATH": f"{self.folder / 'bin'}:{kept['PATH']}"} | more

    def program(self, name: str) -> Path:
        """One of its programs."""
        return self.folder / "bin" / name

    def call(self, cwd: Path, program: str, *arguments: object, timeout_s: float = 120, **variables: str):
        """The completed process of a program, called in a folder."""
        command = [self.program(program), *map(str, arguments)]
        environment = self.variables(**variables)
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=timeout_s, env=environment)
