"""Wire and witness of a run in lock-step: what it carries to the core, and what the core answers, goes on tape."""

from __future__ import annotations

from tailor.executive.core.state import Output
from tailor.executive.replay import RecordedTick
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message
from tailor.tools.lockstep.run_writer import RunWriter


class LockstepRecording:
    """Its two methods are handed to episodes.run_episode."""

    def __init__(self, tape: RunWriter) -> None:
        self._tape = tape
        self._carried: dict[int, bytes] = {}  # by id of the reading as the core gets it in the coming tick

    def wire(self, message: Message) -> Message:
        """The reading as bytes and back, as the bus carries it."""
        data = encode(message)
        heard = decode(type(message), data)
        assert not isinstance(heard, Rejected), heard.reason
        self._carried[id(heard)] = data
        return heard

    def witness(self, tick: RecordedTick, outputs: tuple[Output, ...]) -> None:
        """Write the tick."""
        self._tape.write(tick, [self._carried[id(sample.message)] for sample in tick.inputs.samples], outputs)
        self._carried.clear()
