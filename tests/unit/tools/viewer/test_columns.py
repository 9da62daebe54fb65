"""Samples packed into columns are those that came, to the last digit that the page shows."""

from __future__ import annotations

import json
import tracemalloc
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.schemas import messages as m
from tailor.schemas.codec import encode
from tailor.tools.viewer.columns import Packing
from tailor.tools.viewer.recorded_events import recorded_events
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support import synthetic_run

NUMBERS = st.none() | st.floats(-1e6, 1e6).map(lambda value: round(value, 4)) | st.just(1e15)
FIELDS = st.fixed_dictionaries(
    {"x": NUMBERS, "values": st.lists(NUMBERS, max_size=2)},
    optional={"places": st.dictionaries(st.sampled_from(["ball", "cup"]), st.lists(NUMBERS, min_size=3, max_size=3))},
)


def samples_of(block: dict) -> list:
    """What columns.js makes of a block."""
    length = block["length"]

    def column(packed, factor: float) -> list:
        if isinstance(packed, dict):
            return packed["plain"]
        return [total / factor for total in accumulate([*packed, *[0] * (length - len(packed))])]

    def fields(like, i: int):
        if isinstance(like, dict):
            return {name: fields(part, i) for name, part in like.items()}
        return [fields(part, i) for part in like] if isinstance(like, list) else columns[like][i]

    columns = [column(each, 1e4) for each in block["columns"]]
    return [(at, fields(block["like"], i)) for i, at in enumerate(column(block["at"], 1e3))]


def packed(events) -> tuple[list, list]:
    """The rows and the blocks of events."""
    packing = Packing()
    return list(packing.rows(events)), list(packing.blocks())


def unpacked(blocks: list) -> list:
    return [sample for block in blocks for sample in samples_of(json.loads(block))]


@given(st.lists(FIELDS, min_size=1, max_size=8))
def test_counted_samples_come_back_whole(fields) -> None:
    rows, blocks = packed(Event(0.1 * i, "tick", each) for i, each in enumerate(fields))
    assert rows == []
    assert unpacked(blocks) == [(pytest.approx(0.1 * i), each) for i, each in enumerate(fields)]


@given(st.lists(st.tuples(st.integers(0, 2), NUMBERS), min_size=1, max_size=12))
def test_what_is_left_out_repeats_both_its_neighbours(pairs) -> None:
    fields = [{"x": x, "y": y} for x, y in pairs]
    _, blocks = packed(Event(float(i), "belief", each) for i, each in enumerate(fields))
    kept = dict(unpacked(blocks))
    assert {0.0, len(fields) - 1.0} <= kept.keys()
    assert all(fields[int(at_s)] == each for at_s, each in kept.items())
    lost = [i for i in range(len(fields)) if i not in kept]
    assert all(fields[i - 1] == fields[i] == fields[i + 1] for i in lost)
    repeated = [i for i in range(1, len(fields) - 1) if fields[i - 1] == fields[i] == fields[i + 1]]
    assert lost == repeated


def test_a_robot_at_rest_for_an_hour_has_two_samples() -> None:
    _, (block,) = packed(Event(0.1 * i, "truth", {"x": 1.0, "phi": None}) for i in range(36_000))
    assert samples_of(json.loads(block)) == [
        (0.0, {"x": 1.0, "phi": None}),
        (pytest.approx(3599.9), {"x": 1.0, "phi": None}),
    ]


def test_states_stay_rows() -> None:
    rows, blocks = packed([Event(1.0, "plan", {"text": "a"})])
    assert (rows, blocks) == (['[1.0,"plan",{"text":"a"}]'], [])


def test_memory_follows_what_is_shown() -> None:
    """Not the tables in which samples come: 600 000 messages fit into 10 kB of a recording."""
    hour = (Event(0.1 * i, "belief", {"elapsed": 0.1 * i, "values": [0.5 * i, 1.0]}) for i in range(36_000))
    tracemalloc.start()
    try:
        packed(hour)
        assert tracemalloc.get_traced_memory()[1] < 12_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("robots_pose", [True, False])
def test_odometry_is_read_only_where_nothing_better_is_recorded(robots_pose, tmp_path) -> None:
    writer = McapWriter(tmp_path / "run.mcap", {})
    odometry = [(0.1 * i, "agilo/odom", m.Odometry(0, 1.0, 2.0, 0.0, 0.1 * i, 0.0)) for i in range(5)]
    others = [(t.time_ns / 1e9, t.key, t.message) for t in synthetic_run.soccer_run()] if robots_pose else []
    for number, (at_s, key, message) in enumerate([*odometry, *others]):
        kind = encoding_of(type(message))
        origin = pack(Origin(number, 0, synthetic_run.SENDER))
        writer.write(Raw(key, encode(message), origin, kind, True, None), 10**18 + int(1e9 * at_s))
    writer.close()
    kinds = {event.kind for event in recorded_events(tmp_path / "run.mcap", RunTimeline())}
    assert ("odom" in kinds) != robots_pose
    assert ("believed" in kinds) == robots_pose
