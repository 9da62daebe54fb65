"""CPU time of planners as problems grow."""

import sys

from rich.console import Console

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


def test_a_planner_that_is_not_installed_has_not_failed_to_find_a_plan(monkeypatch):
    row = {"cups": 2, "vhpop": 82, **dict.fromkeys((*planning_scale.ENGINES, "kairos"), (8, 0.003)), "pyperplan": None}
    monkeypatch.setattr(planning_scale, "rows", lambda quick: [row])
    monkeypatch.setattr(planning_scale, "find_spec", lambda name: name != "pyperplan" or None)
    console = Console(width=200, record=True)
    planning_scale.run(console, quick=True)
    text = console.export_text()
    assert "no plan" not in text
    assert "pyperplan is not installed: not measured" in text
