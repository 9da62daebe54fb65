"""SAFETY.md as data: its promises, the tests that hold them, and the list of faults."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tests.support.safety.promises import quantity

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "SAFETY.md"
TABLE = "| test | tries | worst | limit |\n|---|---|---|---|\n"
_PROMISE = re.compile(r"^### (P\d+) (.+)\n\n(.+)\n\nFaults: (.*)\. (Not promised: .+)\n\n((?:\|.*\n)*)", re.MULTILINE)
_TEST = re.compile(r"^\| `([\w/.]+::\w+)`(?: \((.+?)\))? \| (.*?) \| (.*?) \| (.*?) \|$")
_FAULT = re.compile(r"^\| (\d+) \| (.+?) \| (.+?) \|$", re.MULTILINE)


@dataclass(frozen=True)
class Promise:
    """One promise of the page."""

    number: str  # "P1"
    title: str
    statement: str
    faults: frozenset[int]
    limits: str  # what it does not promise
    rows: tuple[tuple[str, str, str, str, str], ...]  # test, figure, tries, worst, limit

    @property
    def tests(self):
        """The tests that hold it, as path::name."""
        return {row[0] for row in self.rows}


def read_promises(text):
    """All promises of the page, in its order."""
    promises = []
    for number, title, statement, faults, limits, table in _PROMISE.findall(text):
        lines = table.splitlines()
        assert "\n".join(lines[:2]) + "\n" == TABLE, f"{number}: expected a table of tests"
        rows = [_TEST.match(line) for line in lines[2:]]
        assert rows, f"{number}: no test"
        assert all(rows), f"{number}: a row is not like | `path::test` | tries | worst | limit |"
        cells = tuple(tuple(cell or "" for cell in row.groups()) for row in rows)
        numbers = frozenset(int(fault) for fault in faults.split(", "))
        promises.append(Promise(number, title, statement, numbers, limits, cells))
    return promises


def read_faults(text):
    """The list of faults: promises, or the reason for having none, by number of the fault."""
    return {int(number): promises for number, _, promises in _FAULT.findall(text)}


def renewed(text, results):
    """The page with the figures of `results`, the rows that `--promises-json` wrote; others stay."""
    by_test = {}
    for row in results:
        by_test.setdefault(row["test"], []).append(row)
    for promise in read_promises(text):
        old = TABLE + "".join(_line(*row) for row in promise.rows)
        assert old in text, promise.number
        text = text.replace(old, TABLE + _rows(promise, by_test), 1)
    return text


def _rows(promise, by_test):
    lines, seen = [], set()
    for row in promise.rows:
        test = row[0]
        if test not in by_test:
            lines.append(_line(*row))
        elif test not in seen:
            lines += [_measured_line(result) for result in by_test[test]]
        seen.add(test)
    return "".join(lines)


def _measured_line(row):
    limits = (quantity(row["worst"], row["unit"]), quantity(row["limit"], row["unit"]))
    return _line(row["test"], row["what"], str(row["tries"]), *limits)


def _line(test, what, tries, worst, limit):
    return f"| `{test}`{f' ({what})' if what else ''} | {tries} | {worst} | {limit} |\n"
