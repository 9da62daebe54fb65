"""Fixtures of tests that gather."""

from collections.abc import Iterator

import pytest

from tailor.tools.learning.gathering import manifests


@pytest.fixture(scope="module")
def few_draws() -> Iterator[None]:
    """Ranges in manifests from few samples: each preparation of three data sets saves a second."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(manifests, "RANGE_DRAWS", 64)
        yield
