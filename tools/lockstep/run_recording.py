"""Records a run in lock-step: the readings that the core receives and the outputs of each tick."""

from __future__ import annotations

from tailor.executive.core.state import Output
from tailor.executive.replay import RecordedTick
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.tools.lockstep.run_writer import RunWriter


class LockstepRecording:
    """Provides the arguments `transport` and `on_tick` of `run_lockstep`."""

    def __init__(self, writer: RunWriter) -> None:
        self._writer = writer
        self._encoded: dict[int, bytes] = {}  # by id of the reading that the core receives in the coming tick

    def transport(self, message: Message) -> Message:
        """Encode and decode the reading, as the bus does."""
        data = encode(message)
        received = decode(type(message), data)
        assert not isinstance(received, Rejected), received.reason
        self._encoded[id(received)] = data
        return received

    def on_tick(self, tick: RecordedTick, outputs: tuple[Output, ...]) -> None:
        """Write the tick."""
        self._writer.write(tick, [self._encoded[id(sample.message)] for sample in tick.inputs.samples], outputs)
        self._encoded.clear()
