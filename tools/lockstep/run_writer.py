"""Writes a run of the core without a bus as a recorder would: same topics, same tick records.

The file holds what `tailor verify` needs: inputs and outputs of the core. It holds no time of writing, so equal runs
give equal bytes.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.executive.core.state import Output
from tailor.executive.deliberation.context import Context
from tailor.executive.replay import RecordedTick
from tailor.executive.shell import tick_report
from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.loop import Period
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.schemas.codec import encode
from tailor.schemas.messages import Message, Provenance
from tailor.schemas.topics import TOPICS, key_of


class RunWriter:
    """Recording of one executive's run; messages carry the times of its ticks."""

    def __init__(self, path: Path, context: Context, provenance: Mapping[str, Any], compact: bool = False) -> None:
        """Create the file.

        Args:
          path: MCAP file to write.
          context: Context of the run.
          provenance: Provenance of the run, JSON values.
          compact: Write no index, which halves the size.
        """
        self._file = McapWriter(path, {}, compact)
        self._context = context
        self._sequences: Counter[str] = Counter()  # by key
        self._provenance = json.dumps(provenance, sort_keys=True)

    def write(self, tick: RecordedTick, inputs: Sequence[bytes], outputs: tuple[Output, ...]) -> None:
        """Add one tick, its report last.

        Args:
          tick: Inputs of the core.
          inputs: Bytes of the samples, in their order. Encoding them again may change the last bit of a heading, which
            is a quaternion in the message.
          outputs: Outputs of the core.
        """
        now_ns, stamp_ns = tick.now_ns, self._context.stamp(tick.now_ns)
        for sample, data in zip(tick.inputs.samples, inputs, strict=True):
            origin = Origin(sample.sequence, 0, sample.sender)
            self._write(sample.key, type(sample.message), data, sample.arrival_ns, origin)
        if tick.tick == 1:
            self._publish(TOPICS["provenance"].key, Provenance(stamp_ns, self._provenance), now_ns)
        for output in outputs:
            self._publish(key_of(output.topic, self._context.domain.robot), output.message, now_ns)
        period = Period(now_ns, now_ns, tick.inputs.skipped)
        report = tick_report(stamp_ns, tick.tick, period, tick.inputs, (0, 0, tick.checks))
        self._publish(TOPICS["tick"].key, report, now_ns)

    def close(self) -> None:
        """Complete the file.

        Raises:
          OSError: The disk is full; the file is readable up to there.
        """
        if not self._file.close():
            raise OSError(0, self._file.disk_error, str(self._file.path))

    def _publish(self, key: str, message: Message, now_ns: int) -> None:
        self._sequences[key] += 1
        self._write(key, type(message), encode(message), now_ns, Origin(self._sequences[key], 0, self._context.sender))

    def _write(self, key: str, kind: type, data: bytes, time_ns: int, origin: Origin) -> None:
        raw = Raw(key, data, pack(origin), encoding_of(kind), True, None)
        self._file.write(raw, self._context.stamp(time_ns))
