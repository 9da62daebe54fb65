"""`tailor new robot` writes a complete package, refuses names that cannot be used, and overwrites nothing."""

import json
import subprocess
import sys
import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from tailor.executive.interfaces.domain import Conflict, LabelQuery, Scenario
from tailor.schemas.errors import UsageError
from tailor.tools.main import main
from tailor.tools.new_robot import templates
from tailor.tools.new_robot.templates import kinds, rendered, write_robot

KINDS = pytest.mark.parametrize("kind", kinds())
ROOT = Path(__file__).resolve().parents[4]
MYPY = ["mypy", "--strict", "--ignore-missing-imports", "cart"]


@KINDS
def test_a_package_has_every_part(kind: str) -> None:
    files = rendered("two-arms", kind)
    assert {"pyproject.toml", "README.md", "two_arms/__init__.py", "two_arms/scene.xml"} <= files.keys()
    assert {"two_arms/domain.pddl", "two_arms/driver.toml", "two_arms/sampler.py", "two_arms/body.py"} <= files.keys()
    assert any(path.startswith("tests/test_") for path in files)
    project = tomllib.loads(files["pyproject.toml"])
    assert project["project"]["entry-points"]["tailor.domains"] == {"two-arms": "two_arms:SPEC"}


@KINDS
def test_what_installs_a_new_robot_installs_the_pytest_that_its_readme_runs(kind: str) -> None:
    """`tailor[all]` brings none: the pytest of another environment answered, which does not know `--tailor-domain`."""
    files = rendered("cart", kind)
    (pytest_,) = tomllib.loads(files["pyproject.toml"])["project"]["optional-dependencies"]["test"]
    assert pytest_.startswith("pytest>=")
    assert "pip install -e '.[test]'" in files["README.md"]


@KINDS
def test_the_wheel_of_a_new_robot_takes_every_kind_of_file_that_a_package_may_have(kind: str) -> None:
    """An editable install hides what is missing: own messages were found there, and lost in the wheel."""
    files = rendered("cart", kind)
    paths = (*(ROOT / "tests" / "support" / "robots" / "forklift" / "truck").rglob("*"), *map(Path, files))
    beside_code = {f"*{path.suffix}" for path in paths if path.suffix} - {"*.py", "*.pyc", "*.md"}
    declared = tomllib.loads(files["pyproject.toml"])["tool"]["setuptools"]["package-data"]["*"]
    assert {"*.msg", "*.toml", "*.pddl", "*.xml"} <= beside_code <= set(declared)


@KINDS
def test_no_placeholder_is_left(kind: str) -> None:
    assert [path for path, text in rendered("cart", kind).items() if "$" in path + text or "template" in path] == []


@pytest.fixture(scope="module")
def types_cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What mypy knows of our own code and of numpy after the first kind: three of four seconds of the next one."""
    return tmp_path_factory.mktemp("mypy")


@KINDS
def test_what_is_written_has_the_style_and_the_types_of_our_own_code(kind: str, tmp_path: Path, types_cache) -> None:
    folder = write_robot("cart", kind, tmp_path)
    config = ["--config", ROOT / "pyproject.toml"]
    types = [*MYPY, "--cache-dir", types_cache]
    for command in (["ruff", "check", *config, "."], ["ruff", "format", "--check", *config, "."], types):
        done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, cwd=folder)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(("kind", "leg"), [("wheeled", "leg_m"), ("arm", "leg_rad")])
def test_a_leg_that_fits_nowhere_is_refused_and_not_drawn_for_ever(kind: str, leg: str) -> None:
    files, module = rendered("cart", kind), {"__name__": "drawing"}
    exec(files["cart/drawing.py"], module)
    for path in (path for path in files if path.startswith("cart/scenarios/") and path.endswith(".toml")):
        declared = tomllib.loads(files[path])
        labels = declared["stations" if kind == "wheeled" else "waypoints"]
        assert len(module["draw"](declared, np.random.default_rng(0))[1]) == len(labels)
        with pytest.raises(ValueError, match=f"{leg} is 99 to 100, expected a leg that fits"):
            module["draw"]({**declared, leg: [99, 100]}, np.random.default_rng(0))


@KINDS
def test_an_object_of_the_problem_without_a_place_is_a_conflict(kind: str, tmp_path: Path, monkeypatch) -> None:
    write_robot(f"placeless-{kind}", kind, tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path / f"placeless-{kind}"))
    domain = import_module(f"placeless_{kind}.domain").make()
    query = LabelQuery("x", "s1", (("next", "home", "s1"),), (), domain.initial_belief(), Scenario("tour", "", {}))
    with pytest.raises(Conflict, match="the scenario draws no place for s1"):
        domain.value(query)


@pytest.mark.parametrize("kind", kinds())
def test_a_package_stays_small(kind: str) -> None:
    files = rendered("cart", kind)
    assert {path: text.count("\n") for path, text in files.items() if text.count("\n") > 130} == {}
    assert sum(text.count("\n") for text in files.values()) < 700


def test_a_script_reads_where_the_package_lies(tmp_path: Path, capsys) -> None:
    assert main(["new", "robot", "cart", "--into", str(tmp_path), "--json"]) == 0
    written = json.loads(capsys.readouterr().out)
    assert written["folder"] == str(tmp_path / "cart")
    assert written["files"] == sum(path.is_file() for path in (tmp_path / "cart").rglob("*"))


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("Cart", "expected lower-case letters"),
        ("2carts", "expected lower-case letters"),
        ("exec", "expected another name: keys of Tailor's own begin with it"),
        ("", "expected lower-case letters"),
        ("../cart", "expected lower-case letters"),
        ("cart-", "expected a letter or digit at its end"),
        ("cart_", "expected a letter or digit at its end"),
        ("class", "a word of Python"),
        ("json", "a Python module 'json'"),
        ("tests", "lies beside the package"),
        ("numpy", "a Python module 'numpy'"),
        ("tailor", "a Python module 'tailor'"),
        ("soccer", "has it already"),
        ("agilo", "has it already"),
    ],
)
def test_a_name_that_cannot_be_used_is_refused_in_one_line(name: str, reason: str, tmp_path: Path, capsys) -> None:
    assert main(["new", "robot", name, "--into", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert reason in error
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("there", ["file", "folder", "dead link"])
def test_nothing_is_overwritten(there: str, tmp_path: Path, capsys) -> None:
    path = tmp_path / "cart"
    if there == "file":
        path.touch()
    elif there == "folder":
        path.mkdir()
    else:
        path.symlink_to(tmp_path / "nowhere")
    assert main(["new", "robot", "cart", "--into", str(tmp_path)]) == 2
    assert "nothing is overwritten" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_to_write_into_must_exist(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="expected an existing folder"):
        write_robot("cart", "wheeled", tmp_path / "nowhere")


def test_a_folder_that_cannot_be_written_is_named_as_it_was_given(tmp_path: Path, capsys) -> None:
    name = "a" * 300
    assert main(["new", "robot", name, "--into", str(tmp_path)]) == 2
    expected = f"{tmp_path / name}: File name too long, expected a folder that can be written"
    assert capsys.readouterr().err == f"tailor new: {expected}\n"


def test_an_interrupted_command_leaves_nothing(tmp_path: Path, monkeypatch) -> None:
    def broken(name: str, kind: str) -> dict[str, str]:
        return {"a": "text", "b": None}  # type: ignore[dict-item]

    monkeypatch.setattr(templates, "rendered", broken)
    with pytest.raises(TypeError):
        write_robot("cart", "wheeled", tmp_path)
    assert list(tmp_path.iterdir()) == []
