"""docs/reasons.md lists the driver's reasons completely."""

import re
from pathlib import Path

import pytest

from tailor.schemas.errors import DecodeRefusal
from tailor.simnodes.reasons import ArmRefusal, CommandRefusal, HoldRefusal, Mode, Reason

PAGE = Path(__file__).resolve().parents[3] / "docs" / "reasons.md"
ROW = re.compile(r"^\| `(\w+)` \| (?:`([^`]+)`|\*\(empty\)\*) \|", re.MULTILINE)
ENUMS = (Mode, Reason, CommandRefusal, ArmRefusal, HoldRefusal, DecodeRefusal)


def driver_section() -> str:
    return PAGE.read_text(encoding="utf-8").partition("\n## Driver\n")[2].partition("\n## ")[0]


@pytest.mark.parametrize("enum", ENUMS)
def test_the_page_lists_exactly_the_members_of_each_enum(enum):
    listed = [value for name, value in ROW.findall(driver_section()) if name == enum.__name__]
    assert listed == [member.value for member in enum]


def test_the_page_lists_no_other_enum():
    assert {name for name, _ in ROW.findall(driver_section())} == {enum.__name__ for enum in ENUMS}
