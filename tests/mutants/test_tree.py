"""A run of a mutant's tests, on a project of one function: only a failing test kills."""

import subprocess

import pytest

from tests.mutants.mutant import Mutant
from tests.mutants.tree import copied
from tests.support.patience import gone

CODE = "def is_small(x):\n    return x < 1\n"
TESTS = """
import time
import code_under_test

def test_small():
    assert code_under_test.is_small(0)
    assert not code_under_test.is_small(1)
"""
MUTANTS = {
    "killed": ("x < 1", "x <= 1"),
    "survived": ("x < 1", "x < 0.5"),
    "broken": ("def is_small", "raise ImportError\n\ndef is_small"),
    "timed out": ("return", "while True: pass\n    return"),
}


@pytest.fixture
def tree(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # the function's tests need none, and loading takes long
    project = tmp_path / "project"
    project.mkdir()
    (project / "code_under_test.py").write_text(CODE)
    (project / "test_it.py").write_text(TESTS)
    (project / "pytest.ini").write_text("[pytest]\npythonpath = .\n")
    subprocess.run(["git", "init", "-q", project], check=True)
    return copied(project, tmp_path / "copy")


@pytest.mark.parametrize("status", MUTANTS)
def test_only_a_failing_test_kills_a_mutant(tree, status):
    mutant = Mutant("m", "code_under_test.py", *MUTANTS[status], ("test_it.py",))
    with tree.mutated(mutant):
        outcome = tree.run(mutant.tests, 1.5 if status == "timed out" else 60.0)
    assert outcome.status == status
    if status == "killed":
        assert outcome.by == "test_it.py::test_small"


def test_the_original_passes_before_and_after_a_mutant_of_the_same_size(tree):
    mutant = Mutant("m", "code_under_test.py", "x < 1", "x > 1", ("test_it.py",))
    before = tree.run(mutant.tests, 60.0)
    with tree.mutated(mutant):
        assert tree.run(mutant.tests, 60.0).status == "killed", "at once, with the same length and time"
    assert [before.status, tree.run(mutant.tests, 60.0).status] == ["survived"] * 2
    assert (tree.folder / mutant.file).read_text() == CODE


def test_a_test_that_cannot_be_set_up_kills_nothing(tree):
    (tree.folder / "test_it.py").write_text(
        "import pytest\n\n@pytest.fixture\ndef x():\n    raise ValueError\n\ndef test_x(x):\n    pass\n"
    )
    assert tree.run(["test_it.py"], 60.0).status == "broken"


LEAVING = """
import subprocess

def test_x():
    child = subprocess.Popen(["sleep", "600"], start_new_session=True)
    with open("pid", "w") as file:
        file.write(str(child.pid))
"""


def test_processes_that_a_test_left_behind_are_ended(tree):
    (tree.folder / "test_it.py").write_text(LEAVING)
    assert tree.run(["test_it.py"], 60.0).status == "survived"
    assert gone(int((tree.folder / "pid").read_text()))
