"""SAFETY.md and the tests agree: each promise names tests that carry its marker, and each marked test is named."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.safety.page import PAGE, ROOT, TABLE, read_faults, read_promises, renewed
from tests.support.safety.promises import Measured, Summary
from tests.support.safety.renew import main

TEXT = PAGE.read_text()
PROMISES = read_promises(TEXT)
EXAMPLE = f"""### P7 Title

Statement.

Faults: 7, 8. Not promised: more.

{TABLE}| `tests/faults/test_a.py::test_a` | 1 | 0.1 s | 0.4 s |
| `tests/faults/test_b.py::test_b` |  |  |  |
"""


def numbers_in(node: ast.AST) -> list[str]:
    """Arguments of all `pytest.mark.promise(...)` in a piece of code."""
    calls = [call for call in ast.walk(node) if isinstance(call, ast.Call)]
    marks = [call for call in calls if isinstance(call.func, ast.Attribute) and call.func.attr == "promise"]
    return [ast.literal_eval(argument) for mark in marks for argument in mark.args]


def marked_in(path: Path) -> set[tuple[str, str]]:
    """(promise, path::name) of a file of tests; a marker stands at a test, or at the assignment of a test case."""
    found = set()
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef):
            names, marks = [node.name], node.decorator_list
        elif isinstance(node, ast.Assign):
            names, marks = [target.id for target in node.targets if isinstance(target, ast.Name)], [node.value]
        else:
            continue
        for name in names:
            found |= {(n, f"{path.relative_to(ROOT)}::{name}") for mark in marks for n in numbers_in(mark)}
    return found


def test_the_page_and_the_markers_agree_both_ways() -> None:
    named = {(promise.number, test) for promise in PROMISES for test in promise.tests}
    marked = set().union(*(marked_in(path) for path in sorted((ROOT / "tests").rglob("test_*.py"))))
    marked = {(number, test) for number, test in marked if "test_safety_page" not in test}
    assert named - marked == set(), "tests on the page without the marker of their promise"
    assert marked - named == set(), "marked tests that are not on the page"


def test_every_heading_of_a_promise_is_read() -> None:
    headings = [line.split()[1] for line in TEXT.splitlines() if line.startswith("### P")]
    assert [promise.number for promise in PROMISES] == headings
    assert headings == sorted(set(headings), key=lambda number: int(number[1:]))


def test_the_list_of_faults_names_the_promises_that_cover_them() -> None:
    faults = read_faults(TEXT)
    assert list(faults) == list(range(1, max(faults) + 1))
    for number, promises in faults.items():
        covering = [promise.number for promise in PROMISES if number in promise.faults]
        assert promises == (", ".join(covering) or "open"), f"fault {number}"
    for promise in PROMISES:
        assert promise.number == f"P{min(promise.faults)}", "a promise has the number of its first fault"


def test_figures_of_a_run_replace_those_of_the_page_and_others_stay() -> None:
    row = {"test": "tests/faults/test_b.py::test_b", "unit": "s", "limit": 0.5, "tries": 23}
    results = [row | {"what": "", "worst": 0.25}, row | {"what": "again", "worst": 0.3}]
    rows = read_promises(renewed(EXAMPLE, results))[0].rows
    assert rows == (
        ("tests/faults/test_a.py::test_a", "", "1", "0.1 s", "0.4 s"),
        ("tests/faults/test_b.py::test_b", "", "23", "0.25 s", "0.5 s"),
        ("tests/faults/test_b.py::test_b", "again", "23", "0.3 s", "0.5 s"),
    )
    assert renewed(TEXT, []) == TEXT


def test_a_failed_test_renews_nothing(tmp_path, capsys) -> None:
    results = tmp_path / "results.json"
    results.write_text(json.dumps([{"test": "tests/faults/test_b.py::test_b", "passed": False}]))
    assert main(results) == 1
    assert "test_b" in capsys.readouterr().err
    assert PAGE.read_text() == TEXT


def test_a_figure_beyond_its_limit_fails_the_test() -> None:
    properties = []
    measured = Measured(properties)
    measured.add(0.4, 0.4)
    with pytest.raises(AssertionError, match=r"measured: 0\.41 s, promised 0\.4 s"):
        measured.add(0.41, 0.4)
    assert [value["value"] for _, value in properties] == [0.4, 0.41]


class Report:
    """The report of one run of a test, as pytest or xdist passes it on."""

    def __init__(self, nodeid, outcome, *figures, when="call"):
        self.nodeid, self.when = nodeid, when
        self.passed, self.failed = outcome == "passed", outcome == "failed"
        figures = [("figure", {"what": "", "value": value, "limit": 1.0, "unit": "s"}) for value in figures]
        self.user_properties = [("promises", ["P7"]), *figures]


def test_the_summary_adds_up_tries_over_parameters_and_takes_the_worst_value() -> None:
    summary = Summary(config=None)
    for report in (
        Report("a.py::test_a[3]", "passed", 0.1, 0.3),
        Report("a.py::test_a[20]", "passed", 0.2),
        Report("a.py::test_b", "failed"),
        Report("a.py::test_c", "failed", when="setup"),
        Report("a.py::test_d::runTest", "passed"),
        Report("a.py::test_d", "passed", when="teardown"),
    ):
        summary.pytest_runtest_logreport(report)
    lines = [line.split() for line in summary.lines(summary.rows())[1:]]
    assert lines == [
        ["P7", "a.py::test_a", "3", "0.3", "s", "1", "s", "passed"],
        ["P7", "a.py::test_b", "0", "FAILED"],
        ["P7", "a.py::test_c", "0", "FAILED"],
        ["P7", "a.py::test_d", "1", "passed"],
    ]


@pytest.mark.slow
def test_make_test_faults_collects_each_test_of_the_page_and_no_other() -> None:
    """A marker that pytest does not collect, e.g. of a test that is defined twice, passes for a kept promise."""
    makefile = (ROOT / "Makefile").read_text()
    assert "pytest -m promise --promises" in makefile
    argv = [sys.executable, "-m", "pytest", "-m", "promise", "--collect-only", "tests"]
    lines = subprocess.run(argv, cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    collected = {"::".join(line.partition("[")[0].split("::")[:2]) for line in lines if "::" in line}
    assert collected == {test for promise in PROMISES for test in promise.tests}
