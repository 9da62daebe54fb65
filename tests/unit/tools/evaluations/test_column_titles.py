"""Columns of reports in words."""

import pytest

from tailor.tools.evaluations.pages.column_titles import column_title


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("scenario", "scenario"),
        ("n", "n"),
        ("improvement_pct", "improvement, %"),
        ("mean_greedy_s", "mean greedy, s"),
        ("ci95", "95 % interval"),
        ("p_value", "p value"),
        ("arrival_heading_rad_refined", "arrival heading refined, rad"),
        ("failures_pct_more_ci95", "failures difference 95 % interval, %"),
        ("arrival_position_m_p", "arrival position p"),
    ],
)
def test_a_column_is_titled_in_words_with_its_unit(name, title):
    assert column_title(name) == title
