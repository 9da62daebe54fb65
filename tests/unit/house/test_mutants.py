"""The lists of mutants stay in step with the code and the tests."""

import re

import pytest

from tests.mutants.mutant import ROOT, Mutant, problem, read_mutants

MUTANTS = read_mutants()


def test_there_are_at_least_forty_mutants_with_plain_names():
    assert len(MUTANTS) >= 40
    assert [mutant.name for mutant in MUTANTS if not re.fullmatch("[a-z0-9]+(-[a-z0-9]+)+", mutant.name)] == []


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_mutant_fits_the_code(mutant):
    assert problem(mutant) == ""


def test_the_readme_counts_them():
    assert re.search(r"(\d+) hand-made mistakes", (ROOT / "README.md").read_text())[1] == str(len(MUTANTS))


def test_no_two_mutants_are_the_same_mistake():
    mistakes = [(mutant.file, mutant.mutate((ROOT / mutant.file).read_text())) for mutant in MUTANTS]
    assert len(set(mistakes)) == len(mistakes)


GOOD = Mutant("a-b", "code.py", "x < 1", "x <= 1", ("test_code.py::test_x",))


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, ""),
        ({"file": "gone.py"}, "gone.py does not exist"),
        ({"old": "x > 1"}, "the old text occurs 0 times in code.py, expected once"),
        ({"old": "x"}, "the old text occurs 2 times in code.py, expected once"),
        ({"new": "x <"}, "the new text is no Python, or means the same"),
        ({"new": "(x) < 1"}, "the new text is no Python, or means the same"),
        ({"tests": ()}, "it names no test"),
        ({"tests": ("gone.py",)}, "no such test: gone.py"),
        ({"tests": ("test_code.py", "test_code.py::test_y")}, "no such test: test_code.py::test_y"),
    ],
)
def test_a_mutant_that_does_not_fit_is_reported(tmp_path, changes, expected):
    (tmp_path / "code.py").write_text("y = 2\n\ndef f(x):\n    return x < 1\n")
    (tmp_path / "test_code.py").write_text("def test_x():\n    pass\n")
    fields = {name: getattr(GOOD, name) for name in ("name", "file", "old", "new", "tests")}
    assert problem(Mutant(**fields | changes), tmp_path) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('[a]\nfile = "f"\nold = "x"\nnew = "y"\n', "mutant a has"),
        ('[a]\nfile = "f"\nold = "x"\nnew = "y"\ntests = []\nexpect = "error"\n', "mutant a has"),
    ],
)
def test_an_entry_with_other_keys_is_refused(tmp_path, text, expected):
    (tmp_path / "list.toml").write_text(text)
    with pytest.raises(ValueError, match=expected):
        read_mutants(tmp_path)


def test_a_name_stands_for_one_mutant(tmp_path):
    entry = '[a]\nfile = "f"\nold = "x"\nnew = "y"\ntests = []\n'
    for name in ("one.toml", "two.toml"):
        (tmp_path / name).write_text(entry)
    with pytest.raises(ValueError, match="two mutants are named a"):
        read_mutants(tmp_path)
