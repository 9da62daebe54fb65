"""Pages name flags and settings that exist, so that what is copied from them is not refused."""

import argparse
import dataclasses
import importlib
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tailor.tools.cli.systems.deployment import Deployment
from tailor.tools.commands.measure.evaluate import RESUME
from tailor.tools.evaluations.catalogue import EVALUATIONS
from tailor.tools.main import COMMANDS
from tests.unit.house.arrows import ROOT

PAGES = sorted([ROOT / "README.md", ROOT / "SAFETY.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")])
INLINE = re.compile(r"`(tailor [^`]+)`")
LINE = re.compile(r"^(?:\$ )?(?:sudo )?(tailor .+)$", re.MULTILINE)
REMARK = re.compile(r"\s#\s.*|\s{4,}.*|\s\|\s.*|'[^']*'")  # beside a command, after a pipe, or the value of a flag
FLAG = re.compile(r"(?<![\w-])--[a-z][\w-]*")
SETTING = re.compile(r"`\[([a-z_.]+)\](?: ([a-z_]+))?[^`]*`")
OF_DRIVERS = {"limits", "command"}  # tables of driver.toml


def commands(text: str) -> Iterator[list[str]]:
    """Words of each command that a page names: inline, or on a line of its own."""
    for match in [*INLINE.finditer(text), *LINE.finditer(text)]:
        yield REMARK.sub("", match[1]).split()[1:]


def parser_of(module: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser()
    importlib.import_module(module).configure(parser)
    return parser


@cache
def flags(command: str) -> frozenset[str]:
    """Flags of a command, of its subcommands and of its evaluations."""
    parsers, known = [parser_of(COMMANDS[command][0])], {"--help"}
    if command == "evaluate":
        parsers += [parser_of(module) for module, _ in EVALUATIONS.values()]
        known.add(RESUME)
    for parser in parsers:
        known |= set(parser._option_string_actions)
        nested = [each.choices for each in parser._actions if isinstance(each, argparse._SubParsersAction)]
        parsers += [inner for choices in nested for inner in choices.values()]
    return frozenset(known)


def unknown_flags(text: str) -> set[str]:
    named = [(words[0], FLAG.findall(" ".join(words))) for words in commands(text) if words and words[0] in COMMANDS]
    return {f"{command} {flag}" for command, given in named for flag in given if flag not in flags(command)}


def tables(value: Any, name: str) -> Iterator[tuple[str, set[str]]]:
    """Name and keys of each table of a deployment file."""
    yield name, {field.name for field in dataclasses.fields(value)}
    for field in dataclasses.fields(value):
        held = getattr(value, field.name)
        if dataclasses.is_dataclass(held):
            yield from tables(held, f"{name}.{field.name}".lstrip("."))


def unknown_settings(text: str) -> set[str]:
    known = dict(tables(Deployment(), ""))
    named = {(table, key) for table, key in SETTING.findall(text) if table not in OF_DRIVERS}
    wrong = [(table, key) for table, key in named if table not in known or (key and key not in known[table])]
    return {f"[{table}] {key}".strip() for table, key in wrong}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_names_flags_and_settings_that_exist(page: Path) -> None:
    text = page.read_text()
    assert (unknown_flags(text), unknown_settings(text)) == (set(), set())


def test_flags_and_settings_that_do_not_exist_are_noticed() -> None:
    text = "`tailor up soccer --engine kairos`\n$ tailor evaluate table3 --luck 3   # --once\n`tailor info 'a --b'`"
    assert unknown_flags(text) == {"up --engine", "evaluate --luck"}
    assert unknown_settings("`[bus] profile`, `[planner] costs`, `[executive.refinement]`") == set()
    assert unknown_settings("`[bus] port`, `[refinement]`") == {"[bus] port", "[refinement]"}
