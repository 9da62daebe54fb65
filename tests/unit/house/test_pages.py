"""Pages name files, folders and commands that exist."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

import tailor
from tailor.tools.main import COMMANDS, GROUPS
from tests.unit.house import draw_clauses, draw_topics
from tests.unit.house.arrows import OURS, ROOMS, ROOT

PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    "SAFETY.md",
    *sorted(f"docs/{page.name}" for page in (ROOT / "docs").glob("*.md")),
]
REFERENCE = sorted(f"docs/robots/{page.name}" for page in (ROOT / "docs" / "robots").glob("*.md"))
SITE = ("guide", "reference")
GUIDE = sorted(f"docs/{name}/{page.name}" for name in SITE for page in (ROOT / "docs" / name).glob("*.md"))
COMMANDS_BY_GROUP = [name for group in GROUPS for name in COMMANDS if group in COMMANDS[name][0].split(".")]
GENERATED = {"commands.md", "configuration.md"}  # by docs/site/hooks.py
TOPS = "|".join(sorted(OURS | {"tests", "docs", "examples"}))
PATH = re.compile(rf"`((?:{TOPS}|core|planning|refinement)/[\w./-]*)`")
TABLE = re.compile(r"`([A-Z][A-Z_]{4,})` in `")
LINK = re.compile(r"\]\((?!http|#)([^)#]+)")
COMMAND = re.compile(r"(?:^|\$ |`)tailor ([a-z][a-z-]*)", re.MULTILINE)


def exists(path: str) -> bool:
    return any((ROOT / folder / path).exists() for folder in ("", "executive"))


def known(page: Path) -> bool:
    return page.exists() or (page.parent.resolve() == ROOT / "docs" / "reference" and page.name in GENERATED)


@pytest.mark.parametrize("page", PAGES + REFERENCE + GUIDE)
def test_a_page_names_files_that_exist(page: str) -> None:
    text = (ROOT / page).read_text()
    assert {path for path in PATH.findall(text) if not exists(path)} == set()
    folder = (ROOT / page).parent
    assert {link for link in LINK.findall(text) if not known(folder / link)} == set()


@pytest.mark.parametrize("page", PAGES + REFERENCE + GUIDE)
def test_a_table_that_a_page_names_beside_a_file_is_in_that_file(page: str) -> None:
    for line in (ROOT / page).read_text().splitlines():
        files = [path for path in PATH.findall(line) if path.endswith(".py") and (ROOT / path).exists()]
        source = "".join((ROOT / path).read_text() for path in files)
        assert not files or {name for name in TABLE.findall(line) if name not in source} == set(), line


@pytest.mark.parametrize("page", PAGES + REFERENCE + GUIDE)
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


@pytest.mark.parametrize("page", draw_topics.HEADS)
def test_the_pages_on_security_and_messages_list_every_role_and_every_topic(page: str) -> None:
    assert draw_topics.drawn(page) == draw_topics.text_of(page), "run `python -m tests.unit.house.draw_topics`"


def test_the_page_on_the_contract_lists_every_clause() -> None:
    page = draw_clauses.PAGE.read_text()
    assert draw_clauses.drawn(page) == page, "run `python -m tests.unit.house.draw_clauses`"


def test_the_site_has_every_page_in_its_navigation() -> None:
    listed = set(re.findall(r"- (?:[^:\n]+: )?([\w./-]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    pages = {page.removeprefix("docs/") for page in PAGES + REFERENCE + GUIDE} - {"README.md"}
    assert listed == pages | {f"reference/{name}" for name in GENERATED} | {"CHANGELOG.md"}


def test_the_generated_pages_hold_every_command_and_every_setting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(ROOT / "docs" / "site"), *sys.path])
    commands = importlib.import_module("commands_page").commands_page()
    assert re.findall("^### tailor (.+)$", commands, re.MULTILINE) == COMMANDS_BY_GROUP
    page = importlib.import_module("configuration_page").configuration_page()
    assert "## `[executive.refinement]`" in page
    assert "| `horizon` | `int` | `2` | actions optimised together" in page
    assert "## `[planner]`" in page
    assert "## `[executive.external]`" not in page, "read_deployment refuses it"
    lines = [re.sub(r"`[^`]*`", "code", line) for line in f"{commands}\n{page}".splitlines() if line.startswith("|")]
    rows = [line.split("|")[1:-1] for line in lines]
    assert {len(row) for row in rows} == {2, 4}, "a bar ends a cell"
    assert [row for row in rows if not row[-1].strip() or "SUPPRESS" in row[-1] or "<" in row[-1]] == []
    assert re.search(r"`arrival_spread` .* standard deviation of the robot's arrival", page), "comments of other keys"


@pytest.mark.slow
def test_the_site_is_built_without_a_broken_link(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs", reason="extra docs")
    command = [sys.executable, "-m", "mkdocs", "build", "--site-dir", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    html = "".join(page.read_text() for page in tmp_path.rglob("*.html"))
    assert re.findall(r"<(?:script|link|img)[^>]+(?:src|href)=[\"']?https?:", html) == []
