"""docs/reasons.md lists the executive's reasons completely."""

import re

from tailor.executive.interfaces.reasons import REASONS, Reason, Result
from tests.support.bus_system import ROOT

PAGE = ROOT / "docs" / "reasons.md"
ROW = re.compile(r"^\| `(\w+)` \| (?:`([^`]+)`|\*\(empty\)\*) \| (.*?) ?\|$", re.MULTILINE)


def rows() -> list[tuple[str, str, str]]:
    return ROW.findall(PAGE.read_text(encoding="utf-8").partition("\n## Executive\n")[2].partition("\n## ")[0])


def test_the_table_has_every_reason_in_the_order_of_the_enum():
    assert list(REASONS) == list(Reason)


def test_the_page_lists_exactly_the_reasons_of_the_table_with_their_meaning():
    listed = [
        (value, tuple(cell.strip() for cell in rest.split(" |"))) for name, value, rest in rows() if name == "Reason"
    ]
    assert listed == [(reason.value, tuple(row)) for reason, row in REASONS.items()]


def test_the_page_lists_exactly_the_results():
    assert [value for name, value, _ in rows() if name == "Result"] == [result.value for result in Result]
    assert {name for name, _, _ in rows()} == {"Reason", "Result"}
