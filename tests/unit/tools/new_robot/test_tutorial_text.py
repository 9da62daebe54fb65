"""The tutorial shows the code that `tailor new robot` writes."""

import re
from pathlib import Path

from tailor.simnodes.driver_spec import read_driver_spec
from tailor.tools.new_robot.templates import rendered

PAGE = Path(__file__).resolve().parents[4] / "docs" / "new-robot.md"
EXCERPT = re.compile(r"```python\n(.*?)```", re.DOTALL)


def test_every_excerpt_is_in_a_file_of_the_new_robot() -> None:
    excerpts, files = EXCERPT.findall(PAGE.read_text()), rendered("courier", "wheeled").values()
    assert len(excerpts) >= 2
    assert [text for text in excerpts if not any(text in file for file in files)] == []


def test_the_driver_file_of_the_reference_is_shorter_but_no_other() -> None:
    page = (PAGE.parent / "robots" / "driver.md").read_text()
    shown, _ = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    whole = rendered("courier", "wheeled")["courier/driver.toml"]
    assert [line for line in shown.splitlines() if line not in whole.splitlines()] == []


def test_the_driver_files_of_the_reference_can_be_read() -> None:
    page = (PAGE.parent / "robots" / "driver.md").read_text()
    one, several = map(read_driver_spec, re.findall(r"```toml\n(.*?)```", page, re.DOTALL))
    assert one.command_topics == ("cmd_vel",)
    assert several.command_topics == ("cmd_vel", "grip")
    assert several.axes == ("v", "width")
