"""docs/reasons.md lists the problems of `tailor status` completely."""

import re

from tailor.tools.status.health import Problem
from tests.support.bus_system import ROOT

ROW = re.compile(r"^\| `Problem` \| `([^`]+)` \|", re.MULTILINE)


def test_the_page_lists_exactly_the_problems():
    page = (ROOT / "docs" / "reasons.md").read_text(encoding="utf-8")
    assert ROW.findall(page.partition("\n## Health\n")[2].partition("\n## ")[0]) == [each.value for each in Problem]
