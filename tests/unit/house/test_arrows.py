"""Imports follow the table of rooms (rooms.toml), which architecture.md draws."""

import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path

import pytest

from tests.unit.house.arrows import (
    MODULES,
    ONE_PLACE,
    OURS,
    ROOMS,
    ROOT,
    Arrow,
    all_imports,
    arrow_between,
    circles,
    imported_modules,
    imported_names,
    is_allowed,
    room_in,
)
from tests.unit.house.draw_map import ARCHITECTURE, with_map

IMPURE = {"zenoh", "time", "os", "threading", "logging", "random", "subprocess", "socket", "asyncio", "signal"}
SHELL = "executive/shell.py"
STANDARD_ONLY = tuple(
    f"simnodes/{name}.py" for name in ("guard", "arming", "hold", "reasons", "stamps")
)  # for hardware
MAX_FILES = 15  # beside __init__.py; a folder with more is divided into rooms
PROJECT_FILES = sorted(MODULES)


def top_names(path: str) -> set[str]:
    return {name.split(".")[0] for name in imported_names(path)}


def forbidden(importer: str, imported: str) -> Arrow | None:
    """The arrow of an import if the table forbids it. The shell is where the executive meets the bus and the clock."""
    arrow = arrow_between(importer, imported)
    if arrow is None or is_allowed(arrow) or (importer == SHELL and imported.startswith("runtime/")):
        return None
    return arrow


def test_every_import_follows_an_arrow_of_the_table() -> None:
    assert {(str(arrow), path, other) for path, other in all_imports() if (arrow := forbidden(path, other))} == set()


@pytest.mark.parametrize("folder", ROOMS)
def test_a_room_imports_only_rooms_above_it_in_the_table(folder: str) -> None:
    above: set[str] = set()
    for room, row in ROOMS[folder].items():
        assert set(row["imports"]) <= above, f"{folder}: {room}"
        above.add(room)


@pytest.mark.parametrize("folder", ROOMS)
def test_the_table_has_every_room(folder: str) -> None:
    inside = [p for p in PROJECT_FILES if folder == "." or p.startswith(f"{folder}/")]
    rooms = {room_in(folder, p) for p in inside if Path(p).name != "__init__.py" or room_in(folder, p) != "root"}
    assert rooms - {"root"} == set(ROOMS[folder]) - {"root"}
    assert rooms <= set(ROOMS[folder])


def test_every_folder_that_holds_rooms_has_a_table() -> None:
    folders = {Path(p).parent.as_posix() for p in PROJECT_FILES}
    assert {Path(folder).parent.as_posix() for folder in folders} <= set(ROOMS)


def test_no_modules_import_each_other_in_a_circle() -> None:
    graph: dict[str, set[str]] = defaultdict(set)
    for importer, imported in all_imports():
        graph[importer].add(imported)
    assert circles(graph) == set()


def test_no_folder_holds_more_files_than_one_can_overlook() -> None:
    files = [p for p in ROOT.glob("*/**/*.py") if p.relative_to(ROOT).parts[0] in {*OURS, "tests"}]
    counts = Counter(p.parent.relative_to(ROOT).as_posix() for p in files if p.name != "__init__.py")
    assert {folder: count for folder, count in counts.items() if count > MAX_FILES} == {}


def test_only_main_imports_commands() -> None:
    importers = {importer for importer, imported in all_imports() if imported.startswith("tools/commands/")}
    assert importers <= {"tools/main.py"}


def test_folders_of_unit_tests_mirror_the_code() -> None:
    unit = ROOT / "tests" / "unit"
    folders = {p.parent.relative_to(unit) for p in unit.rglob("test_*.py")}
    of_code = {folder for folder in folders if folder.parts[0] != "house"}
    assert {folder.as_posix() for folder in of_code if not (ROOT / folder / "__init__.py").exists()} == set()


def test_no_import_is_bare() -> None:
    """`import executive` would load a second copy of the module: the checkout is on the path under pytest."""
    assert {path: bare for path in PROJECT_FILES if (bare := top_names(path) & OURS)} == {}


def test_rooms_import_the_planner_itself_and_not_its_name_for_programs() -> None:
    """`tailor.planning` is in no room: an import of it would escape the table."""
    assert [path for path in PROJECT_FILES if "tailor.planning" in imported_names(path)] == []


def test_the_core_is_pure() -> None:
    core = [path for path in PROJECT_FILES if path.startswith("executive/")]
    models = {(path, p) for path in core for p in imported_modules(path) if p.startswith("models/")}
    assert {imported for _, imported in models} == {"models/runtime.py"}, models
    assert {path: impure for path in core if path != SHELL and (impure := top_names(path) & IMPURE)} == {}


@pytest.mark.parametrize("path", STANDARD_ONLY)
def test_the_guard_needs_the_standard_library_only(path: str) -> None:
    ours = {p for p in imported_modules(path) if not p.endswith("__init__.py")}
    assert ours <= set(STANDARD_ONLY)
    assert top_names(path) - {"tailor"} <= set(sys.stdlib_module_names)


@pytest.mark.parametrize("library", ONE_PLACE)
def test_a_library_with_one_place_is_imported_nowhere_else(library: str) -> None:
    assert [p for p in PROJECT_FILES if library in top_names(p)] == ONE_PLACE[library]


LEARNING = ["sklearn", "skl2onnx", "onnx", "joblib", "pyarrow", "mujoco", "matplotlib"]


def test_the_executive_process_loads_no_learning_library() -> None:
    loading = "import sys, tailor.executive.shell, tailor.executive.composition"
    code = f"{loading}; print(sorted(set({LEARNING}) & set(sys.modules)))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert out.stdout.strip() == "[]"


def test_the_map_in_the_docs_is_the_table() -> None:
    page = ARCHITECTURE.read_text()
    assert page == with_map(page), "run `python -m tests.unit.house.draw_map`"
