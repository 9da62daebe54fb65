"""Hardware is found by module or file; whatever is none is one clear line."""

import sys
from importlib import import_module

import pytest

from tailor.schemas.errors import UsageError
from tailor.simnodes.hardware.loading import load_hardware
from tests.support.bus_system import ROOT
from tests.unit.simnodes.hardware.faulty import Faulty

WRONG = {
    "no_such_module:Rover": "No module named",
    "math:Rover": "has no attribute 'Rover'",
    "missing.py:Rover": "no file missing.py",
    "fractions:Fraction": "no subclass of",
    "Rover": r"^Rover: expected FILE\.toml, package\.module:Class or FILE\.py:Class$",
    ":Rover": "expected FILE",
    "tailor.simnodes.hardware.interface:Hardware": "robot is empty",
    f"{__name__}:NeverWriting": r"write_hz is 0\.0, expected a number from 0\.001 to 1e\+06",
    f"{__name__}:WritingFast": r"write_hz is 'fast', expected a number from 0\.001 to 1e\+06",
    f"{__name__}:HardlyWriting": r"write_hz is 1e-310, expected a number from 0\.001 to 1e\+06",
    f"{__name__}:Patient": r"read_s is 10+\.\.\., expected a number from 0\.001 to 1e\+06",
    f"{__name__}:Unplugged": r"RuntimeError: no board, on no port \(test_loading\.py, line \d+\), expected a class",
    f"{__name__}:Leaving": r"SystemExit: 0 \(test_loading\.py, line \d+\), expected a class",
    f"{__name__}:Unnamed": r"ZeroDivisionError: division by zero \(test_loading\.py, line \d+\), expected a class",
    ".relative:Rover": "expected package.module:Class or FILE.py:Class",
}
BROKEN = {
    "raise KeyError": "KeyError",
    "Rover = 1 / 0": r"ZeroDivisionError: division by zero \(broken\.py, line 1\)",
    "def": "invalid syntax",
    "raise SystemExit(0)": r"SystemExit: 0 \(broken\.py, line 1\)",
}


class NeverWriting(Faulty):
    """Its writer would divide by zero."""

    write_hz = 0.0


class HardlyWriting(Faulty):
    """Its period overflows: the thread that writes would end, and nothing would be written, standstill neither."""

    write_hz = 1e-310


class Patient(Faulty):
    """No thread can wait for so long; the one that closes the device would end by it."""

    def __init__(self):
        super().__init__()
        self.read_s = 10**400


class WritingFast(Faulty):
    """A rate of another type."""

    write_hz = "fast"


class Unplugged(Faulty):
    """It looks for its board when it is made."""

    def __init__(self):
        raise RuntimeError("no board,\non no port")


class Leaving(Faulty):
    """It ended the driver with exit code 0 and without a word."""

    def __init__(self):
        sys.exit(0)


class Unnamed(Faulty):
    """Its name is found out later, which fails."""

    @property
    def robot(self):
        return 1 / 0


def test_a_class_is_found_in_a_file_and_in_a_module():
    assert load_hardware(f"{ROOT}/examples/rover_driver.py:Rover").robot == "agilo"
    assert load_hardware("tests.unit.simnodes.hardware.faulty:Faulty").robot == "agilo"


BESIDE = """
from __future__ import annotations
from dataclasses import dataclass, field
from tests.unit.simnodes.hardware.faulty import Faulty
from board_of_the_rover import PORT

@dataclass
class Settings:
    ports: list[int] = field(default_factory=list)

class Rover(Faulty):
    def ports(self):
        import late_board_of_the_rover
        return [PORT, late_board_of_the_rover.PORT, Settings().ports]
"""


def test_a_file_imports_the_modules_beside_it_and_hides_no_library(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "path", [*sys.path])
    for name, text in {
        "rover_beside": BESIDE,
        "board_of_the_rover": "PORT = 3",
        "late_board_of_the_rover": "PORT = 4",
        "colorsys": "raise ValueError",
    }.items():
        (tmp_path / f"{name}.py").write_text(text)
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.chdir(tmp_path.parent)
    assert load_hardware(f"{tmp_path.name}/rover_beside.py:Rover").ports() == [3, 4, []]
    assert hasattr(import_module("colorsys"), "rgb_to_hsv"), "the library's"


def test_a_file_that_fails_leaves_no_module(tmp_path):
    (tmp_path / "half_a_rover.py").write_text("import missing_board")
    with pytest.raises(UsageError, match="No module named 'missing_board'"):
        load_hardware(f"{tmp_path}/half_a_rover.py:Rover")
    assert "half_a_rover" not in sys.modules


@pytest.mark.parametrize("named", WRONG)
def test_what_is_no_hardware_is_refused_in_one_line(named):
    with pytest.raises(UsageError, match=WRONG[named]) as refused:
        load_hardware(named)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("source", BROKEN)
def test_a_module_that_cannot_be_loaded_is_refused_in_one_line(source, tmp_path):
    file = tmp_path / "broken.py"
    file.write_text(source)
    with pytest.raises(UsageError, match=rf"broken\.py:Rover: .*{BROKEN[source]}.*, expected") as refused:
        load_hardware(f"{file}:Rover")
    assert "\n" not in str(refused.value)
