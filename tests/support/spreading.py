"""An order of tests for several workers: those that start processes and wait lie evenly among those that compute."""

from collections.abc import Callable, Hashable
from typing import TypeVar

Test = TypeVar("Test", bound=Hashable)


def spread(tests: list[Test], waits: Callable[[Test], bool]) -> None:
    """Sort tests in place; those that wait, and the others, keep their order among themselves.

    In the order of folders those that wait come first, while the robots of the live tests are waited for as well: then
    no worker computes.
    """
    parts = ([test for test in tests if waits(test)], [test for test in tests if not waits(test)])
    share = {test: number / len(part) for part in parts for number, test in enumerate(part)}
    tests.sort(key=share.__getitem__)
