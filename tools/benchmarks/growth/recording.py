"""Growth of a recording with its length: its size, and the page that is made of it."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from tailor.tools.benchmarks.growth.curve import Curve
from tailor.tools.goldens.renew import Golden, record
from tailor.tools.viewer.page import page
from tailor.tools.viewer.recorded_events import recorded_events
from tailor.tools.viewer.timeline import RunTimeline

EPISODES = 4
MINUTES = (1.0, 3.0, 10.0, 30.0, 60.0)
PAUSE_NS = 1_000_000_000


def curves(quick: bool) -> Iterator[Curve]:
    """Runs in lock-step, one after another, until the recording is as long as that."""
    with tempfile.TemporaryDirectory() as folder:
        parts = [Path(folder) / f"{seed}.mcap" for seed in range(EPISODES)]
        for seed, part in enumerate(parts):
            record(Golden("soccer", "approach-dribble", seed), part)
        rows = [_row(parts, minutes, Path(folder)) for minutes in (MINUTES[:-2] if quick else MINUTES)]
    columns = ("recording's size, MB", "CPU time of its page, s", "size of its page, MB")
    for number, cost in enumerate(columns, start=1):
        name, unit = cost.split(", ")
        yield Curve(name, "length of the recording, min", f"{name}, {unit}", [(r[0], r[number]) for r in rows], 1.0)


def _row(parts: Sequence[Path], minutes: float, folder: Path) -> tuple[float, float, float, float]:
    """Minutes, MB of the recording, CPU seconds and MB of its page."""
    long = folder / "long.mcap"
    concatenate(parts, minutes, long)
    began = time.process_time()
    text = page("growth", recorded_events(long, RunTimeline()))
    return minutes, long.stat().st_size / 1e6, time.process_time() - began, len(text.encode()) / 1e6


def concatenate(parts: Sequence[Path], minutes: float, path: Path) -> None:
    """Repeat the recordings, each later than the last, until they are as long."""
    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.ZSTD)
        writer.start("ros2")
        channels: dict[tuple[str, str], int] = {}
        at_ns, number = 0, 0
        while at_ns < minutes * 60e9:
            at_ns = _append(writer, parts[number % len(parts)], at_ns, channels) + PAUSE_NS
            number += 1
        writer.finish()  # type: ignore[no-untyped-call]


def _append(writer: Writer, part: Path, at_ns: int, channels: dict[tuple[str, str], int]) -> int:
    """Copy one recording to begin at `at_ns`; returns when it ends."""
    began_ns, end_ns = None, at_ns
    with part.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None
            key = (channel.topic, channel.metadata["sender"])
            if key not in channels:
                kind = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[key] = writer.register_channel(channel.topic, channel.message_encoding, kind, channel.metadata)
            began_ns = message.log_time if began_ns is None else began_ns
            end_ns = at_ns + message.log_time - began_ns
            writer.add_message(channels[key], end_ns, message.data, end_ns, message.sequence)
    return end_ns
