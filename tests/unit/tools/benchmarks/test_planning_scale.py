"""CPU time of planners as problems grow."""

import sys

from tailor.tools.benchmarks import planning_scale


def test_loading_a_planner_counts_in_no_row(monkeypatch):
    """The first row had five times the CPU seconds of kairos-planner: its import was among them."""
    loaded = []
    monkeypatch.setattr(planning_scale, "import_module", loaded.append)
    monkeypatch.setattr(planning_scale, "measured", lambda _: tuple(loaded))
    (first, *_) = planning_scale.rows(quick=True)
    assert first["kairos"] == first["pyperplan"] == ("kairos", "pyperplan.planner")


def test_a_planner_that_is_not_installed_is_not_measured(monkeypatch):
    monkeypatch.setitem(sys.modules, "kairos", None)
    monkeypatch.setitem(sys.modules, "pyperplan", None)
    monkeypatch.setattr(planning_scale, "CUPS", (2, 3))
    monkeypatch.setattr(planning_scale, "steps_by", lambda *_: 8)
    (row,) = planning_scale.rows(quick=True)
    assert (row["kairos"], row["pyperplan"], row["pocl"][0]) == (None, None, 8)
