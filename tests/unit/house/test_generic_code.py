"""Generic code names no robot and no domain: what it needs of them, it takes from the packages of robots."""

import ast
import re
from collections.abc import Iterator

import pytest

from tailor.schemas.packages.discovery import packages
from tests.unit.house.arrows import MODULES, ROOT

NAMES = [name for package in packages() if package.spec for name in (package.spec.name, package.spec.robot)]
THINGS = {*NAMES, "ball", "dribble", "letter"} - {"arm"}  # drivers are armed, too: of this word, only the module counts
CASES = {case for name in THINGS for case in (name, name.capitalize(), name.upper())}
WORDS = re.compile(rf"(?<![a-z])({'|'.join(sorted(CASES))})(?![a-z])|\.domains\.arm\b")

# Folders and files that may name robots, and why.
EXCEPTIONS = {
    "robots/": "declare them",
    "executive/domains/soccer/": "is one",
    "executive/domains/arm/": "is one",
    "executive/domains/kitchen/": "is one",
    "executive/actions/": "controllers for any robot that pushes a ball",
    "executive/belief/": "filters for any robot that sees a ball",
    "simnodes/agilo/": "is one",
    "simnodes/powercube/": "is one",
    "simnodes/b21/": "is one",
    "schemas/messages/soccer.py": "its messages, whose ROS types old recordings name",
    "schemas/messages/kitchen.py": "its messages",
    "schemas/kitchen/": "its geometry, shared by body and executive",
    "models/features/kitchen/": "its feature spaces, a part of its package",
    "tools/lockstep/samplers/": "parts of the packages that ship",
    "tools/evaluations/": "tables and figures of the paper, which name its robots",
    "tools/writing/": "letters, a task of the arm alone",
    "tools/benchmarks/": "measure the robots that ship",
    "tools/soak/": "runs the two robots that ship, whose physics its judges know",
    "tools/goldens/renew.py": "lists the recordings of the robots that ship",
    "tools/commands/run/demo.py": "shows one robot",
    "tools/commands/run/letters.py": "shows the arm",
    "tools/commands/setup/units.py": "default of the command line",
    "tools/evaluations/catalogue.py": "default of the paper's evaluations",
}


def named(path: str) -> Iterator[str]:
    """Names and short texts of a file's code; comments, docstrings and texts for people are left out."""
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        match node:
            case ast.Constant(value=str() as text) if " " not in text.strip() and "\n" not in text:
                yield text
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.arg(arg=name) | ast.keyword(arg=str() as name):
                yield name
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.ImportFrom(module=module, names=aliases):
                yield from (f"{module}.{alias.name}" for alias in aliases)
            case ast.Import(names=aliases):
                yield from (alias.name for alias in aliases)


def robots_in(path: str) -> set[str]:
    """What names a robot or domain that ships in a file."""
    return {name for name in named(path) if WORDS.search(name)}


GENERIC = sorted(path for path in MODULES if not path.startswith(tuple(EXCEPTIONS)))


def test_generic_code_names_no_robot() -> None:
    assert {path: names for path in GENERIC if (names := robots_in(path))} == {}


@pytest.mark.parametrize("exception", EXCEPTIONS)
def test_every_exception_is_needed(exception: str) -> None:
    assert any(robots_in(path) for path in MODULES if path.startswith(exception))


def test_most_code_is_generic() -> None:
    assert len(GENERIC) > len(MODULES) / 2
