"""Every imported package is declared, explained and pinned."""

import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from tailor.tools.cli.extras import BENCHMARKS_NEED, EXTRAS, NEEDS
from tailor.tools.commands.measure.bench import BENCHMARKS, ON_REQUEST
from tailor.tools.main import COMMANDS
from tests.unit.house.arrows import MODULES, ROOT, imported_names

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
TEST_MODULES = [
    p.relative_to(ROOT).as_posix() for folder in ("tests", "examples") for p in (ROOT / folder).rglob("*.py")
]
OURS = {"tailor", "tests", "truck", "porter"}  # the last two: robots' packages that tests install
DISTRIBUTIONS = packages_distributions()


def canonical(name: str) -> str:
    """Name of a distribution as PEP 503 compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def declared(requirements: list[str]) -> set[str]:
    return {canonical(re.split(r"[<>=!~ ;\[]", requirement)[0]) for requirement in requirements}


EXTRA = PROJECT["optional-dependencies"]
OF_USERS = sorted(EXTRA.keys() - {"all", "docs", "test", "ros"})  # extras that users install
PLANNERS = declared(EXTRA["kairos"] + EXTRA["up"])
RUN = declared(PROJECT["dependencies"] + [line for extra in OF_USERS for line in EXTRA[extra]]) - PLANNERS
TEST = declared(EXTRA["test"] + EXTRA["ros"]) - {"tailor"}
SITE = declared(EXTRA["docs"])
UNBOUNDED = {"cryptography", "pyarrow", "rich"}  # major versions often, none broke us: docs/dependencies.md
PINNED = declared((ROOT / "constraints.txt").read_text().split())
OF_EXAMPLES = {"rerun"}  # for those who have it; Tailor needs no viewer
OPTIONAL = {"cma", "pyperplan", "pytest", *PLANNERS}  # benchmarks leave out what is not installed; pytest's plug-in


def imported_distributions(paths: list[str]) -> dict[str, str]:
    """Distribution -> one of the files that import it, without ours and the standard library."""
    found: dict[str, str] = {}
    for path in paths:
        for name in {name.split(".")[0] for name in imported_names(path)} - OURS - set(sys.stdlib_module_names):
            # Of a meta-package, or of ROS 2's that is not installed.
            known = {canonical(name), f"ros-{canonical(name)}"} & (RUN | TEST | PLANNERS)
            found[known.pop() if known else canonical(DISTRIBUTIONS.get(name, [name])[0])] = path
    return found


def test_every_package_that_the_code_imports_is_a_dependency() -> None:
    imported = imported_distributions(sorted(MODULES))
    assert {name: path for name, path in imported.items() if name not in RUN | OPTIONAL} == {}


def test_every_dependency_has_an_upper_bound() -> None:
    lines = [*PROJECT["dependencies"], *(line for extra in OF_USERS for line in EXTRA[extra])]
    assert {canonical(re.split("[<>=]", line)[0]) for line in lines if "<" not in line} == UNBOUNDED


def test_the_table_of_extras_names_what_they_bring() -> None:
    for extra in OF_USERS:
        brought = [{canonical(name) for name in DISTRIBUTIONS.get(m, [m])} for m in EXTRAS[extra]]
        assert all(names & declared(EXTRA[extra]) for names in brought), extra
        assert len(brought) == len(EXTRA[extra])
    assert set(re.findall(r"[\w-]+", EXTRA["all"][0])) - {"tailor"} == set(OF_USERS)


def test_commands_that_need_an_extra_exist() -> None:
    assert NEEDS.keys() <= COMMANDS.keys()
    assert BENCHMARKS_NEED.keys() <= {*BENCHMARKS, *ON_REQUEST}
    assert {
        extra for needs in (NEEDS, BENCHMARKS_NEED) for extras in needs.values() for extra in extras
    } <= EXTRAS.keys()


def test_every_dependency_is_imported() -> None:
    assert RUN - imported_distributions(sorted(MODULES)).keys() == set()


def test_every_package_that_the_tests_import_is_declared() -> None:
    imported = imported_distributions(TEST_MODULES)
    assert {name: path for name, path in imported.items() if name not in RUN | TEST | OF_EXAMPLES} == {}


@pytest.mark.parametrize("name", sorted(RUN | TEST | PLANNERS | SITE))
def test_a_dependency_is_pinned_and_explained(name: str) -> None:
    assert name in PINNED
    page = (Path(ROOT) / "docs" / "dependencies.md").read_text()
    first_cells = {
        canonical(cell) for row in re.findall(r"^\| ([^|]+) \|", page, re.MULTILINE) for cell in row.split(", ")
    }
    assert name in first_cells
