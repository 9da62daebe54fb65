"""Substitutes a live executive for a recorded one: it receives the recorded sensors, without the recorded outputs."""

from __future__ import annotations

import time
from dataclasses import replace

from tailor.runtime.bus.session import Session
from tailor.runtime.recordings.recording import Recorded
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import type_of

SUBSTITUTES = ("executive",)
OMITTED = tuple(name for name, topic in TOPICS.items() if topic.source in ("executive", "people", "player"))
WAIT_S = 10.0  # for a status of the live executive


def live_executive(session: Session) -> str:
    """Sender id of the executive that runs on this bus.

    Raises:
      UsageError: No executive publishes its status in time.
    """
    inbox, ends = session.inbox(["status"], ""), time.monotonic() + WAIT_S
    while time.monotonic() < ends:
        for sample in inbox.drain():
            return sample.sender
        time.sleep(0.02)
    raise UsageError(
        f"--substitute executive: no executive on this bus within {WAIT_S:g} s, expected `tailor executive DOMAIN`"
    )


def armed_for(sender: str, recorded: Recorded) -> Recorded:
    """The message for the live executive `sender`: a driver that obeyed the recorded one appears to obey it.

    It echoes no command: those of the recording have stamps of another clock, and seem minutes old.
    """
    if type_of(recorded.ros_type) is not DriverState:
        return recorded
    state = decode(DriverState, recorded.data)
    if not isinstance(state, DriverState) or not state.armed_sender:
        return recorded
    return replace(recorded, data=encode(replace(state, armed_sender=sender, command_stamp_ns=0)))
