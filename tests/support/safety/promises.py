"""Pytest plugin: which tests hold the promises of SAFETY.md, and what they measured.

A test names its promises with the marker `promise("P1")` and adds what it measured with the fixture `measured`.
`--promises` prints the table, `--promises-json FILE` writes it. Works with xdist: the figures travel with the reports.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import pytest

PROMISES, FIGURE = "promises", "figure"  # names of the properties of a report


def pytest_addoption(parser):
    group = parser.getgroup("promises")
    group.addoption("--promises", action="store_true", help="print the table of promises of SAFETY.md")
    group.addoption("--promises-json", metavar="FILE", type=Path, help="write that table as JSON")


def pytest_configure(config):
    config.addinivalue_line("markers", "promise(number, ...): holds these promises of SAFETY.md")
    if not hasattr(config, "workerinput"):  # a worker of xdist only sends reports
        config.pluginmanager.register(Summary(config), "promises-summary")


def pytest_collection_modifyitems(items):
    for item in items:
        numbers = [number for mark in item.iter_markers("promise") for number in mark.args]
        if numbers:
            item.user_properties.append((PROMISES, numbers))


class Measured:
    """What one test measured."""

    def __init__(self, properties):
        self._properties = properties

    def add(self, value, limit, unit="s", what=""):
        """Record a figure and fail if it exceeds its limit.

        Args:
          value: Worst value of one try; call this once a try.
          limit: Largest value that keeps the promise.
          unit: Unit of both.
          what: Name of the figure, if a test measures several.
        """
        self._properties.append((FIGURE, {"what": what, "value": value, "limit": limit, "unit": unit}))
        assert value <= limit, f"{what or 'measured'}: {value:.4g} {unit}, promised {limit:g} {unit}"


@pytest.fixture
def measured(request):
    """Collects what a test measured for the table of promises."""
    return Measured(request.node.user_properties)


@dataclass
class Row:
    """One figure of one test, or one test without figures, over all its parameters and tries."""

    test: str  # path::name
    promises: list[str]
    what: str = ""
    unit: str = ""
    limit: float | None = None
    worst: float | None = None
    tries: int = 0

    def add(self, figure):
        self.tries += 1
        self.unit, self.limit = figure["unit"], figure["limit"]
        self.worst = figure["value"] if self.worst is None else max(self.worst, figure["value"])


@dataclass
class Outcome:
    """What happened to one test function, over all its parameters."""

    promises: list[str]
    passed: int = 0
    failed: int = 0
    rows: dict[str, Row] = field(default_factory=dict)


class Summary:
    """Collects the reports of all tests that hold promises."""

    def __init__(self, config):
        self.outcomes: dict[str, Outcome] = {}
        self._config = config

    def pytest_runtest_logreport(self, report):
        properties = report.user_properties
        promises = [number for name, value in properties if name == PROMISES for number in value]
        if not promises or (report.when != "call" and not report.failed):
            return
        test = "::".join(report.nodeid.partition("@")[0].partition("[")[0].split("::")[:2])
        outcome = self.outcomes.setdefault(test, Outcome(promises))
        outcome.passed += report.when == "call" and report.passed
        outcome.failed += report.failed
        figures = [value for name, value in properties if name == FIGURE] if report.when == "call" else []
        for figure in figures:
            outcome.rows.setdefault(figure["what"], Row(test, promises, figure["what"])).add(figure)

    def rows(self):
        """All rows, by number of the promise; a test without figures counts its passed runs as tries."""
        rows = []
        for test, outcome in self.outcomes.items():
            rows += outcome.rows.values() or [Row(test, outcome.promises, tries=outcome.passed)]
        return sorted(rows, key=lambda row: (min(int(number[1:]) for number in row.promises), row.test))

    def pytest_terminal_summary(self, terminalreporter):
        rows = self.rows()
        if path := self._config.getoption("promises_json"):
            failed = {test for test, outcome in self.outcomes.items() if outcome.failed}
            table = [vars(row) | {"passed": row.test not in failed} for row in rows]
            path.write_text(json.dumps(table, indent=1) + "\n")
        if self._config.getoption("promises"):
            terminalreporter.section("promises of SAFETY.md")
            for line in self.lines(rows):
                terminalreporter.write_line(line)

    def lines(self, rows):
        """The table as text."""
        table = [("promise", "test", "tries", "worst", "limit", "")]
        for row in rows:
            name = f"{row.test.rpartition('/')[2]}{f' ({row.what})' if row.what else ''}"
            verdict = "FAILED" if self.outcomes[row.test].failed else "passed" if row.tries else "skipped"
            limits = (quantity(row.worst, row.unit), quantity(row.limit, row.unit))
            table.append((" ".join(row.promises), name, str(row.tries), *limits, verdict))
        widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
        return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table]


def quantity(value, unit):
    """A figure of the table, e.g. "0.276 s"; empty for None."""
    return "" if value is None else f"{value:.3g} {unit}".rstrip()
