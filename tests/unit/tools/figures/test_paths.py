"""Still pictures of runs: as flat as the run, with a legend that a run of many actions does not fill."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.figure import Figure

from tailor.tools.figures.paths import HIGHEST_IN, LABELLED, PANEL_IN, draw_path, figure_of, size_in
from tailor.tools.figures.track import Track, TrackPoint
from tailor.tools.scenes.flat import Outline


def labels_of(actions: int) -> list[str]:
    """The legend of a run of as many actions."""
    axis = Figure().subplots()
    points = [TrackPoint(0.1 * i, 0.1 * i, 0.0, 0.0, 1.0, {}, i // 2, "go") for i in range(2 * actions)]
    draw_path(axis, Track("run", points))
    return [text.get_text() for text in axis.get_legend().get_texts()]


def test_a_legend_names_the_first_actions_and_counts_the_others() -> None:
    assert labels_of(LABELLED + 1) == ["go"] * (LABELLED + 1), "one more would take the same line"
    assert labels_of(LABELLED + 5) == [*["go"] * LABELLED, "and 5 more"]


@pytest.mark.parametrize("high_m", [0.3, 1.0, 4.0])
def test_a_legend_lies_below_the_name_of_its_axis(high_m: float) -> None:
    points = [TrackPoint(t, 3.0 * t, high_m * t, None, 1.0, {}, 0, "go") for t in (0.0, 1.0)]
    figure = figure_of([Track("run", points)])
    figure.draw_without_rendering()
    (axis,) = figure.axes
    name, legend = axis.xaxis.label.get_window_extent(), axis.get_legend().get_window_extent()
    assert legend.y1 <= name.y0


def test_a_run_without_motion_has_no_legend() -> None:
    axis = Figure().subplots()
    draw_path(axis, Track("run", []))
    assert axis.get_legend() is None


@pytest.mark.parametrize(
    ("wide_m", "high_m", "of_panel"), [(3.0, 1.0, 0.5), (1.0, 1.0, 1.0), (1.0, 9.0, HIGHEST_IN / PANEL_IN)]
)
def test_a_flat_run_makes_a_flat_picture_and_a_steep_one_ends(wide_m: float, high_m: float, of_panel: float) -> None:
    points = [TrackPoint(t, t * wide_m, t * high_m, 0.0, 1.0, {}, 0, "go") for t in (0.0, 1.0)]
    still = [TrackPoint(0.0, 0.0, 0.0, 0.0, 1.0, {}, 0, "go")] * 2
    height = size_in([Track("run", points)])[1] - size_in([Track("still", still)])[1]
    assert height == pytest.approx(PANEL_IN * (of_panel - 1.0))


def test_no_line_leads_to_where_a_simulator_has_put_a_robot_and_its_objects_at_a_restart() -> None:
    axis = Figure().subplots()
    points = [
        TrackPoint(t, t + 9 * restart, 0.0, None, 1.0, {"ball": (t + 9 * restart, 1.0, 0.0)}, 0, "go", restart)
        for t, restart in ((0.0, 0), (1.0, 0), (2.0, 1), (3.0, 1))
    ]
    outline = Outline(((0.0, 0.0), (0.1, 0.0), (0.1, 0.1)), True, (1.0, 0.0, 0.0, 1.0))
    draw_path(axis, Track("run", points, outlines={"ball": outline}))
    drawn = [line.get_xdata() for line in axis.get_lines() if len(line.get_xdata()) > 1]
    expected = [0.0, 1.0, math.nan, 11.0, 12.0]
    assert len(drawn) == 2
    np.testing.assert_equal(np.array(drawn), np.array([expected, expected]))
