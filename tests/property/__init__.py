"""Property tests with few examples among the fast tests, and many among the slow ones."""

import pytest


def examples(few, many):
    """Parametrizes a test by `count`, the number of hypothesis' examples."""
    return pytest.mark.parametrize("count", [few, pytest.param(many, marks=pytest.mark.slow)])
