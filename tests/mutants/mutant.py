"""The list of mutants: hand-made mistakes in safety code, each with the tests that must see it.

The list must stay in step with the code: `problem` names what no longer fits.
"""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LISTS = Path(__file__).parent
KEYS = {"file", "old", "new", "tests"}


@dataclass(frozen=True, slots=True)
class Mutant:
    """One mistake: in `file`, `old` is replaced by `new`.

    Attributes:
      name: Name in reports and after `--only`.
      file: Path from the root of the project.
      old: Text that occurs exactly once in the file.
      new: The mistaken text.
      tests: Files or node ids of pytest, of which at least one must fail.
    """

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    def mutate(self, text: str) -> str:
        """The text of the file with the mistake in it."""
        return text.replace(self.old, self.new)


def read_mutants(folder: Path = LISTS) -> list[Mutant]:
    """Mutants of all lists in a folder, file by file.

    Raises:
      ValueError: A list is no TOML, an entry has other keys than KEYS, or two mutants have one name.
    """
    mutants: dict[str, Mutant] = {}
    for path in sorted(folder.glob("*.toml")):
        for name, entry in tomllib.loads(path.read_text(encoding="utf-8")).items():
            if entry.keys() != KEYS:
                raise ValueError(f"{path.name}: mutant {name} has {sorted(entry)}, expected {sorted(KEYS)}")
            if name in mutants:
                raise ValueError(f"{path.name}: two mutants are named {name}")
            mutants[name] = Mutant(name, entry["file"], entry["old"], entry["new"], tuple(entry["tests"]))
    return list(mutants.values())


def problem(mutant: Mutant, root: Path = ROOT) -> str:
    """What no longer fits between a mutant and the code; empty if everything does."""
    if not (root / mutant.file).is_file():
        return f"{mutant.file} does not exist"
    text = (root / mutant.file).read_text(encoding="utf-8")
    if text.count(mutant.old) != 1:
        return f"the old text occurs {text.count(mutant.old)} times in {mutant.file}, expected once"
    if _tree(mutant.mutate(text)) in (None, _tree(text)):
        return "the new text is no Python, or means the same"
    missing = [test for test in mutant.tests if not _exists(test, root)]
    return f"no such test: {', '.join(missing)}" if missing else "" if mutant.tests else "it names no test"


def problems(mutants: Iterable[Mutant], root: Path = ROOT) -> list[str]:
    """One line for each mutant that does not fit."""
    return [f"{mutant.name}: {found}" for mutant in mutants if (found := problem(mutant, root))]


@lru_cache(maxsize=8)  # mutants of one file follow each other
def _tree(text: str) -> str | None:
    try:
        return ast.dump(ast.parse(text))
    except SyntaxError:
        return None


def _exists(test: str, root: Path) -> bool:
    """Whether a file of tests exists, and the class or function in it that a node id names."""
    path, *names = test.split("::")
    if not (root / path).is_file():
        return False
    return {name.partition("[")[0] for name in names} <= _defined(root / path)


@cache
def _defined(path: Path) -> set[str]:
    """Names of the classes and functions in a file."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, kinds)}
