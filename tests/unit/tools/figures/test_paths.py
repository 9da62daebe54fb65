"""Still pictures of runs: a legend that a run of many actions does not fill."""

from __future__ import annotations

from matplotlib.figure import Figure

from tailor.tools.figures.paths import LABELLED, draw_path
from tailor.tools.figures.track import Track, TrackPoint


def labels_of(actions: int) -> list[str]:
    """The legend of a run of as many actions."""
    axis = Figure().subplots()
    points = [TrackPoint(0.1 * i, 0.1 * i, 0.0, 0.0, 1.0, {}, i // 2, "go") for i in range(2 * actions)]
    draw_path(axis, Track("run", points))
    return [text.get_text() for text in axis.get_legend().get_texts()]


def test_a_legend_names_the_first_actions_and_counts_the_others() -> None:
    assert labels_of(LABELLED + 1) == ["go"] * (LABELLED + 1), "one more would take the same line"
    assert labels_of(LABELLED + 5) == [*["go"] * LABELLED, "and 5 more"]


def test_a_run_without_motion_has_no_legend() -> None:
    axis = Figure().subplots()
    draw_path(axis, Track("run", []))
    assert axis.get_legend() is None
