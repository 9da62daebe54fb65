"""The measure of CPU time by which limits of tests are judged: the same on slow and on fast machines."""

import pytest

from tests.support.cpu_time import REFERENCE_S, reference, standard_cpu_s


@pytest.mark.parametrize("times", [1, 5])
def test_so_many_references_take_so_many_times_their_standard_time(times):
    def work():
        for _ in range(times):
            reference()

    assert standard_cpu_s(work) == pytest.approx(times * REFERENCE_S, rel=0.5)
