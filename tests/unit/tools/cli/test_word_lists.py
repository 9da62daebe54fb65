"""Long lists of names in a line."""

import pytest

from tailor.tools.cli.word_lists import abbreviated


@pytest.mark.parametrize(
    ("names", "text"), [("", ""), ("a", "a"), ("ab", "a, b"), ("abc", "a, b and 1 more"), ("abcde", "a, b and 3 more")]
)
def test_no_more_names_are_listed_than_fit_and_the_others_are_counted(names, text):
    assert abbreviated(names, 2) == text


def test_names_may_follow_in_order():
    assert abbreviated(["drive", "grip", "lift"], 2, ", then ") == "drive, then grip and 1 more"
