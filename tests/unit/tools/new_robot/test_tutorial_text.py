"""The tutorial shows the code that `tailor new robot` writes."""

import re
from pathlib import Path

from tailor.tools.new_robot.templates import rendered

PAGE = Path(__file__).resolve().parents[4] / "docs" / "new-robot.md"
EXCERPT = re.compile(r"```python\n(.*?)```", re.DOTALL)


def test_every_excerpt_is_in_a_file_of_the_new_robot() -> None:
    excerpts, files = EXCERPT.findall(PAGE.read_text()), rendered("courier", "wheeled").values()
    assert len(excerpts) >= 2
    assert [text for text in excerpts if not any(text in file for file in files)] == []


def test_the_driver_file_of_the_reference_is_shorter_but_no_other() -> None:
    page = (PAGE.parent / "robots" / "driver.md").read_text()
    [shown] = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    whole = rendered("courier", "wheeled")["courier/driver.toml"]
    assert [line for line in shown.splitlines() if line not in whole.splitlines()] == []
