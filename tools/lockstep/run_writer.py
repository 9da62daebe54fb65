"""Writes down a run of the core that no bus has seen, as a recorder would have: same topics, same tick records.

Only what `tailor verify` needs is in it: the inputs that the core was given, and what it answered. Nothing in it tells
when it was written: the same run gives the same bytes.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.executive.core.context import Context
from tailor.executive.core.state import Output
from tailor.executive.replay import RecordedTick
from tailor.executive.shell import tick_report
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.loop import Period
from tailor.runtime.recordings.mcap_writer import ENCODING, McapWriter
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message, Provenance
from tailor.schemas.topics import TOPICS, key_of
from tailor.schemas.typesystem import ros_type


class RunWriter:
    """One executive's run; messages bear the times of its ticks."""

    def __init__(self, path: Path, context: Context, made_of: Mapping[str, Any], compact: bool = False) -> None:
        """Create the file; `made_of` is the run's provenance. Compact: without an index, half the size."""
        self._tape = McapWriter(path, {}, compact)
        self._context = context
        self._said: Counter[str] = Counter()  # how many of each key, which numbers them
        self._provenance = json.dumps(made_of, sort_keys=True)

    def write(self, tick: RecordedTick, inputs: Sequence[bytes], outputs: tuple[Output, ...]) -> None:
        """Add one tick, its report last.

        Args:
          tick: What the core was given.
          inputs: The samples' bytes, in their order. Encoding them anew would not do: a heading comes as a quaternion,
            and a way to the value and back may cost its last bit.
          outputs: What the core answered.
        """
        now_ns, stamp_ns = tick.now_ns, self._context.stamp(tick.now_ns)
        for sample, data in zip(tick.inputs.samples, inputs, strict=True):
            origin = Origin(sample.sequence, 0, sample.sender)
            self._write(sample.key, type(sample.message), data, sample.arrival_ns, origin)
        if tick.tick == 1:
            self._say(TOPICS["provenance"].key, Provenance(stamp_ns, self._provenance), now_ns)
        for output in outputs:
            self._say(key_of(output.topic, self._context.domain.robot), output.message, now_ns)
        turn = Period(now_ns, now_ns, tick.inputs.skipped)
        report = tick_report(stamp_ns, tick.tick, turn, tick.inputs, (0, 0, tick.checks))
        self._say(TOPICS["tick"].key, report, now_ns)

    def close(self) -> None:
        """Complete the file.

        Raises:
          OSError: The disk has no room for it; what is left of it can be read as far as it goes.
        """
        if not self._tape.close():
            raise OSError(0, self._tape.trouble, str(self._tape.path))

    def _say(self, key: str, message: Message, now_ns: int) -> None:
        self._said[key] += 1
        self._write(key, type(message), encode(message), now_ns, Origin(self._said[key], 0, self._context.sender))

    def _write(self, key: str, kind: type, data: bytes, time_ns: int, origin: Origin) -> None:
        raw = Raw(key, data, pack(origin), f"{ENCODING}{ros_type(kind)}", True, None)
        self._tape.write(raw, self._context.stamp(time_ns))
