"""Runs that failed are left out of durations, so their results are named, with a start to repeat."""

import argparse
from dataclasses import replace

from tailor.tools.evaluations.refinement import refinement
from tailor.tools.evaluations.refinement.failed_runs import failure_remarks
from tests.unit.tools.evaluations.test_refinement_evaluations import DONE

LOST, LATE = (replace(DONE, achieved=False, result=f"failed: {why}") for why in ("out of sight", "time limit"))
PAIRS = {("pipes", 7): (LATE, DONE), ("pipes", 8): (LOST, DONE), ("pipes", 9): (LOST, DONE), ("dock", 1): (DONE, DONE)}
GREEDY = (
    "greedy runs that failed: 2 × failed: out of sight (such as pipes, seed 8); "
    "1 × failed: time limit (such as pipes, seed 7)"
)


def test_each_result_is_counted_for_its_side_with_a_start():
    assert list(failure_remarks(PAIRS)) == [GREEDY]


def test_rare_results_are_counted_only():
    many = {("pipes", k): (DONE, replace(LOST, result=f"failed: {min(k, 5)}")) for k in range(10)}
    [line] = failure_remarks(many)
    assert line.startswith("refined runs that failed: 5 × failed: 5 (such as pipes, seed 5); 1 × failed: 0 ")
    assert line.endswith("; 3 other results")


def test_the_report_names_them(monkeypatch):
    reports = []
    monkeypatch.setattr(refinement, "rows_of", lambda *_: ([{"ci95": [0, 0]}], PAIRS))
    monkeypatch.setattr(refinement, "publish_report", lambda report, *_: reports.append(report))
    monkeypatch.setattr(refinement, "is_better", lambda row: True)
    parser = argparse.ArgumentParser()
    refinement.configure(parser)
    assert refinement.run(parser.parse_args(["--domain", "soccer", "--scenario", "waypoints"])) == 0
    assert GREEDY in reports[0].remarks
