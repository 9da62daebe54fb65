"""Reads the messages of a recording with their times."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Message
from tailor.schemas.packages.spec import RESERVED
from tailor.schemas.typesystem import ros_type, type_of
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.word_lists import abbreviated

EXECUTIVE = "exec/"
MAX_NAMED = 4  # executives: a recording of a day may hold dozens
SHOWN_DIGITS = 8  # of a sender, as `tailor info` shows them


@dataclass(frozen=True, slots=True)
class Timed:
    """A message with its key, its time of reception, seconds since the recording's first message, and its sender."""

    at_s: float
    key: str
    message: Message
    sender: str = ""


def timed(
    path: Path,
    sender: str = "",
    without: Collection[type] = (),
    read: Callable[[DamageReport], None] = lambda _: None,
    robot: str = "",
) -> Iterator[Timed]:
    """Messages of a recording in the order of their reception, without damaged ones.

    Args:
      path: MCAP file.
      sender: Skip executives whose id does not begin with this.
      without: Skip messages of these types, without decoding them.
      read: Called with the damage of the file, when all of it has been read.
      robot: There must be a message of this robot, also if it is skipped; empty: of any or none.

    Raises:
      UsageError: The file is no recording, or has no readable message, or none of such an executive or robot.
    """
    began_ns: int | None = None
    executives: set[str] = set()
    owners: set[str] = set()
    skipped = {ros_type(kind) for kind in without}
    recording = open_recording(path)
    for recorded in recording.messages():
        kind = type_of(recorded.ros_type)
        if kind is None:
            continue
        owners.add(recorded.key.partition("/")[0])
        if recorded.key.startswith(EXECUTIVE):
            executives.add(recorded.sender)
            if not recorded.sender.startswith(sender):
                continue
        message = None if recorded.ros_type in skipped else decode(kind, recorded.data)
        if isinstance(message, Rejected):
            continue
        began_ns = recorded.log_ns if began_ns is None else began_ns
        if message is not None:
            yield Timed((recorded.log_ns - began_ns) / 1e9, recorded.key, message, recorded.sender)
    if began_ns is None:
        raise UsageError(f"{path}: no readable message, expected a recording of a run")
    _check_sender(path, sender, executives)
    _check_robot(path, robot, owners)
    read(recording.damage)


def several_executives(path: Path, first_s: Mapping[str, float], what: str) -> str:
    """One line about a recording of several executives, e.g. since one was started anew; empty for one of a single one.

    Args:
      path: The recording.
      first_s: Sender -> seconds of the first of its messages.
      what: Noun of what is shown of them.
    """
    if len(first_s) < 2:
        return ""
    first = sorted(first_s.items(), key=lambda item: item[1])
    each = abbreviated([f"{sender[:SHOWN_DIGITS]} from {at_s:.1f} s on" for sender, at_s in first], MAX_NAMED)
    return f"{plain(path.name)} holds {what} of {len(first)} executives: {each}; --sender shows one of them"


def _check_sender(path: Path, sender: str, executives: Collection[str]) -> None:
    """Raise UsageError if none of the executives in a recording has such an id."""
    if sender and not any(each.startswith(sender) for each in executives):
        known = ", ".join(sorted(each[:SHOWN_DIGITS] for each in executives)) or "none"
        raise UsageError(f"{path}: no executive whose id begins with '{sender}', expected one of: {known}")


def _check_robot(path: Path, robot: str, owners: Collection[str]) -> None:
    """Raise UsageError if no key in a recording begins with the name of the robot."""
    if robot and robot not in owners:
        known = ", ".join(sorted(set(owners).difference(RESERVED))) or "none"
        raise UsageError(f"{path}: no message of robot '{robot}', expected one of: {known}")
