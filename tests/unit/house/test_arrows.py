"""Who may import whom (architecture.md): this reads every import and fails on an arrow that is not in the table."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
OURS = {"schemas", "runtime", "executive", "simnodes", "models", "tools"}
IMPURE = {"zenoh", "time", "os", "threading", "logging", "random", "subprocess", "socket", "asyncio", "signal"}
SHELL = ("executive/shell.py",)
STANDARD_ONLY = ("simnodes/guard.py",)
PROJECT_FILES = sorted(p.relative_to(ROOT).as_posix() for f in OURS for p in (ROOT / f).rglob("*.py"))


def imports(path: str) -> set[str]:
    """Dotted names that a file imports, wherever in it; ours without the `tailor.` in front."""
    found: set[str] = set()
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            found |= {f"{node.module}.{alias.name}" for alias in node.names} | {str(node.module)}
    bare = {name for name in found if name.split(".")[0] in OURS}
    assert not bare, f"{path}: imports {bare}, expected tailor.…: a bare import loads a second copy of the module"
    return {name.removeprefix("tailor.") for name in found}


def tops(names: set[str]) -> set[str]:
    return {name.split(".")[0] for name in names}


def allowed_of_ours(path: str) -> set[str]:
    folder = path.split("/", maxsplit=1)[0]
    if path in SHELL:
        return {"executive", "runtime", "schemas", "models"}
    return {
        "schemas": {"schemas"},
        "models": {"schemas", "models"},
        "runtime": {"schemas", "runtime"},
        "executive": {"schemas", "executive", "models"},
        "simnodes": {"schemas", "runtime", "simnodes"},
        "tools": OURS,
    }[folder]


@pytest.mark.parametrize("path", PROJECT_FILES)
def test_every_import_follows_an_arrow_of_the_table(path: str) -> None:
    names = imports(path)
    assert (tops(names) & OURS) <= allowed_of_ours(path)
    if path.startswith("executive/"):
        assert all(n.startswith("models.runtime") for n in names if n.startswith("models")), (
            "executive: models.runtime only"
        )
        if path not in SHELL:
            assert not tops(names) & IMPURE, "the core is pure"
    if path in STANDARD_ONLY:
        assert tops(names) <= set(sys.stdlib_module_names)


@pytest.mark.parametrize(
    ("library", "place"), [("onnxruntime", "models/runtime.py"), ("zenoh", "runtime/bus/session.py")]
)
def test_a_library_with_one_place_is_imported_nowhere_else(library: str, place: str) -> None:
    assert [p for p in PROJECT_FILES if library in tops(imports(p))] == [place]


LEARNING = ["sklearn", "skl2onnx", "onnx", "joblib", "pyarrow", "mujoco", "matplotlib"]


def test_the_executive_process_loads_no_learning_library() -> None:
    loading = "import sys, tailor.executive.shell, tailor.executive.composition"
    code = f"{loading}; print(sorted(set({LEARNING}) & set(sys.modules)))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert out.stdout.strip() == "[]"
