"""Pages name files, folders and commands that exist."""

import re

import pytest

import tailor
from tailor.tools.main import COMMANDS
from tests.unit.house import draw_clauses, draw_roles
from tests.unit.house.arrows import OURS, ROOMS, ROOT

PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    "SAFETY.md",
    *sorted(f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")),
]
REFERENCE = sorted(f"docs/robots/{page.name}" for page in (ROOT / "docs" / "robots").glob("*.md"))
TOPS = "|".join(sorted(OURS | {"tests", "docs", "examples"}))
PATH = re.compile(rf"`((?:{TOPS}|core|planning|refinement)/[\w./-]*)`")
LINK = re.compile(r"\]\((?!http|#)([^)#]+)")
COMMAND = re.compile(r"(?:^|\$ |`)tailor ([a-z][a-z-]*)", re.MULTILINE)


def exists(path: str) -> bool:
    return any((ROOT / folder / path).exists() for folder in ("", "executive"))


@pytest.mark.parametrize("page", PAGES + REFERENCE)
def test_a_page_names_files_that_exist(page: str) -> None:
    text = (ROOT / page).read_text()
    assert {path for path in PATH.findall(text) if not exists(path)} == set()
    folder = (ROOT / page).parent
    assert {link for link in LINK.findall(text) if not (folder / link).exists()} == set()


@pytest.mark.parametrize("page", PAGES + REFERENCE)
def test_a_page_names_commands_that_exist(page: str) -> None:
    assert set(COMMAND.findall((ROOT / page).read_text())) <= set(COMMANDS)


def test_the_readme_lists_the_folders_of_the_table() -> None:
    rows = re.findall(r"^\| `(\w+)/` \|", (ROOT / "README.md").read_text(), re.MULTILINE)
    assert [row for row in rows if row in OURS] == list(ROOMS["."])


def test_the_readme_links_every_page() -> None:
    links = LINK.findall((ROOT / "README.md").read_text())
    assert set(PAGES) - {"README.md"} <= set(links)


def test_the_tutorial_links_every_page_of_its_reference() -> None:
    links = {f"docs/{link}" for link in LINK.findall((ROOT / "docs" / "new-robot.md").read_text())}
    assert set(REFERENCE) <= links


def test_the_citation_names_the_version() -> None:
    assert re.findall(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE) == [tailor.__version__]


def test_the_page_on_security_lists_every_role_with_its_rights() -> None:
    page = draw_roles.PAGE.read_text()
    assert draw_roles.drawn(page) == page, "run `python -m tests.unit.house.draw_roles`"


def test_the_page_on_the_contract_lists_every_clause() -> None:
    page = draw_clauses.PAGE.read_text()
    assert draw_clauses.drawn(page) == page, "run `python -m tests.unit.house.draw_clauses`"
