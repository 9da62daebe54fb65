"""The base package installs on 64-bit ARM without a compiler, judged by the recorded names of wheels.

`python -m tests.unit.house.test_aarch64` records them anew from the package index, after a change of the pins.
"""

import json
import re
import subprocess
import sys
import tempfile
from importlib.metadata import requires, version

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename

from tests.unit.house.arrows import ROOT
from tests.unit.house.test_dependencies import PROJECT

RECORDED = ROOT / "tests" / "data" / "wheels" / "aarch64.txt"
PYTHONS = ("311", "312", "313")
GLIBC = ("2_17", "2_26", "2_27", "2_28", "2_31")  # what Debian 11 and JetPack 6 have, and older
PINS = dict(line.split("==") for line in (ROOT / "constraints.txt").read_text().split())
PINS = {canonicalize_name(name): version for name, version in PINS.items()}


def is_pinned(requirement: str) -> bool:
    name = canonicalize_name(Requirement(requirement).name)
    return version(name) == PINS[name]


def closure() -> set[str]:
    """The dependencies of the base package, and theirs."""
    found: set[str] = set()
    waiting = list(PROJECT["dependencies"])
    while waiting:
        requirement = Requirement(waiting.pop())
        name = canonicalize_name(requirement.name)
        if name in found or (requirement.marker and not requirement.marker.evaluate({"extra": ""})):
            continue
        found.add(name)
        waiting += requires(name) or []
    return found


def fits(tag: str, python: str) -> bool:
    """Whether a wheel of this tag runs on an aarch64 Linux under this CPython."""
    interpreter, abi, platform = tag.split("-")
    if platform != "any" and not re.fullmatch(r"manylinux(2014|_2_\d+)_aarch64", platform):
        return False
    stable = abi == "abi3" and int(interpreter.removeprefix("cp3")) <= int(python.removeprefix("3"))
    return stable or interpreter == f"cp{python}" or (abi == "none" and interpreter == "py3")


@pytest.mark.skipif(not all(map(is_pinned, PROJECT["dependencies"])), reason="other versions have other dependencies")
@pytest.mark.parametrize("python", PYTHONS)
def test_every_package_of_the_base_has_a_wheel_for_aarch64(python):
    there = set()
    for line in RECORDED.read_text().split():
        name, version, _, tags = parse_wheel_filename(line)
        if PINS.get(name) == str(version) and any(fits(str(tag), python) for tag in tags):
            there.add(name)
    assert closure() - there == set()


def names_from_the_index(python: str) -> set[str]:
    """File names that pip would install on aarch64; nothing is installed."""
    platforms = [f"--platform=manylinux_{version}_aarch64" for version in GLIBC] + ["--platform=manylinux2014_aarch64"]
    with tempfile.TemporaryDirectory() as folder:
        report = f"{folder}/report.json"
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--dry-run", "--ignore-installed"]
        command += ["--only-binary=:all:", "--implementation=cp", f"--python-version={python}", *platforms]
        command += [f"--report={report}", f"--target={folder}", "-c", str(ROOT / "constraints.txt")]
        subprocess.run([*command, *PROJECT["dependencies"]], check=True)
        with open(report, encoding="utf-8") as file:
            installed = json.load(file)["install"]
    return {each["download_info"]["url"].rsplit("/", 1)[1] for each in installed}


if __name__ == "__main__":
    RECORDED.write_text("\n".join(sorted(set().union(*map(names_from_the_index, PYTHONS)))) + "\n")
