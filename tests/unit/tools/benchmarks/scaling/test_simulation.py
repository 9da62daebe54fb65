"""Simulated speed-ups: bounds that hold for any list scheduling."""

from hypothesis import given
from hypothesis import strategies as st

from tailor.tools.benchmarks.scaling.simulation import Overheads, makespan_s, speedup

FREE = Overheads(0.0, 0.0, 0.0)
SECONDS = st.floats(0.0, 10.0)


def test_equal_parts_without_overheads_gain_as_many_times_as_there_are_workers() -> None:
    assert [speedup([2.0] * 64, workers, FREE) for workers in (1, 2, 16, 64, 128)] == [1, 2, 16, 64, 64]


def test_each_overhead_counts_where_it_occurs() -> None:
    assert makespan_s([2.0] * 4, 2, Overheads(1.0, 0.0, 0.0)) == 5.0
    assert makespan_s([2.0] * 4, 2, Overheads(0.0, 0.5, 0.0)) == 5.0
    assert makespan_s([2.0] * 4, 2, Overheads(0.0, 0.0, 0.5)) == 5.0  # two results at once wait for each other
    assert makespan_s([2.0] * 4, 4, Overheads(0.0, 0.0, 3.0)) == 14.0  # writing is the bottleneck


@given(st.lists(SECONDS, min_size=1, max_size=30), st.integers(1, 8), st.builds(Overheads, SECONDS, SECONDS, SECONDS))
def test_no_schedule_beats_its_bounds_and_none_is_worse_than_grahams(parts, workers, overheads) -> None:
    each = [part + overheads.part_s for part in parts]
    least = overheads.start_s + max(*each, sum(each) / workers)
    writing = overheads.write_s * len(parts)
    made = makespan_s(parts, workers, overheads)
    assert made >= max(least + overheads.write_s, writing) - 1e-9
    assert made <= overheads.start_s + sum(each) / workers + max(each) + writing + 1e-9
