"""Chunks of recordings: equal to mcap's own reader; damaged content is refused."""

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from tailor.runtime.recordings.mcap.chunk import records_of
from tailor.runtime.recordings.recording import open_recording
from tailor.tools.recordings.survey import percentiles

GOLDEN = Path(__file__).parents[3] / "data" / "golden" / "soccer-approach.mcap"


def record(opcode, body):
    return struct.pack("<BQ", opcode, len(body)) + body


MESSAGE = record(5, struct.pack("<HIQQ", 3, 7, 10, 9) + b"data")


def test_messages_equal_those_of_mcaps_own_reader():
    with GOLDEN.open("rb") as file:
        theirs = [(m.sequence, m.log_time, m.publish_time, m.data) for _, _, m in make_reader(file).iter_messages()]
    ours = [(m.sequence, m.log_ns, m.publish_ns, m.data) for m in open_recording(GOLDEN).messages()]
    assert sorted(ours) == sorted(theirs)
    assert len(ours) > 300


def test_messages_are_read_and_unknown_records_skipped():
    plain = record(0x77, b"later versions") + MESSAGE
    (found,) = records_of(plain, zlib.crc32(plain))
    assert (found.channel_id, found.sequence, found.log_time, found.publish_time) == (3, 7, 10, 9)
    assert found.data == b"data"


def test_a_missing_checksum_is_not_checked():
    assert len(records_of(MESSAGE, 0)) == 1


@pytest.mark.parametrize(
    ("plain", "crc", "reason"),
    [
        (MESSAGE, 1, "checksum"),
        (MESSAGE[:-1], 0, "exceeds the end"),
        (record(5, b"short"), 0, "shorter than its head"),
        (struct.pack("<BQ", 5, 2**64 - 1), 0, "exceeds the end"),
    ],
)
def test_damaged_content_is_refused(plain, crc, reason):
    with pytest.raises(ValueError, match=reason):
        records_of(plain, crc)


@pytest.mark.parametrize("values", [[], [3.0], [2.0, 1.0], list(np.random.default_rng(0).normal(size=137))])
def test_percentiles_are_numpys(values):
    expected = [round(float(np.percentile(values or [0.0], q)), 3) for q in (50, 99, 100)]
    assert list(percentiles(values).values()) == expected
