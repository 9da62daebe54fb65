"""Writes a run in lock-step as a recording: the topics and tick records of a live run, and the same bits every time.

Only what `tailor verify` needs is in it: the inputs that the core was given, and what it answered.
"""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

from executive.core.context import Context
from executive.core.state import Output
from executive.replay import RecordedTick
from executive.shell import tick_report
from runtime.attachment import Origin, pack
from runtime.inbox import Raw
from runtime.loop import Turn
from runtime.tape import ENCODING, Tape
from schemas.codec import encode
from schemas.messages import Message, Provenance
from schemas.topics import TOPICS, key_of
from schemas.typesystem import ros_type

CHUNK_BYTES = 4_000_000  # a whole run in one piece compresses best


class LockstepRecording:
    """A `Witness` of episodes.run_episode that puts all it sees on tape; times are those of the simulated clock."""

    def __init__(self, path: Path, context: Context, made_of: dict[str, Any]) -> None:
        """Create the file; `made_of` is the run's provenance."""
        self._tape = Tape(path, {}, CHUNK_BYTES)
        self._context = context
        self._said: Counter[str] = Counter()  # how many of each key, which numbers them
        self._provenance = Provenance(context.stamp(0), json.dumps(made_of, sort_keys=True))

    def __call__(self, tick: RecordedTick, outputs: tuple[Output, ...]) -> None:
        """Write one tick, its report last."""
        if tick.tick == 1:
            self._say(TOPICS["provenance"].key, self._provenance, tick.now_ns)
        for sample in tick.inputs.samples:
            self._write(sample.key, sample.message, sample.arrival_ns, Origin(sample.sequence, 0, sample.sender))
        for output in outputs:
            self._say(key_of(output.topic, self._context.domain.robot), output.message, tick.now_ns)
        turn = Turn(tick.now_ns, tick.now_ns, 0)
        report = tick_report(self._context.stamp(tick.now_ns), tick.tick, turn, tick.inputs, (0, 0, tick.checks))
        self._say(TOPICS["tick"].key, report, tick.now_ns)

    def close(self) -> None:
        """Complete the file."""
        self._tape.close()

    def _say(self, key: str, message: Message, now_ns: int) -> None:
        self._said[key] += 1
        self._write(key, message, now_ns, Origin(self._said[key], 0, self._context.sender))

    def _write(self, key: str, message: Message, time_ns: int, origin: Origin) -> None:
        encoding = f"{ENCODING}{ros_type(type(message))}"
        self._tape.write(Raw(key, encode(message), pack(origin), encoding, True, None), time_ns)
