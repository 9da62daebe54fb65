"""Reads the episodes of one recording; messages that cannot be decoded, or are missing, are counted and left out."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.episodes import Episode
from tailor.runtime.recordings.mcap.scan import DamageReport
from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import ActionFinished, Contexts, ExecStatus, Message, Subgoals
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import type_of
from tailor.tools.lockstep.episode_extraction import EpisodeExtractor

READ = (Subgoals, Contexts, ExecStatus, ActionFinished)  # besides sensors and ground truth
# An action that the extractor forgets, and goals that it must not take for those of what runs now.
FORGOTTEN = (ActionFinished(0, 0, "", 0, "aborted", "", 0.0, 0.0), Subgoals(0, 0, 0))
MISSING, DISORDERED = "missing", "out of order"


class RecordedEpisodes:
    """The episodes of one recording.

    The executive rejected a damaged sensor message as well and believed on without it. So its episode stays; only the
    drives' work is unknown, as it is summed over all states of motion. A damaged message of the executive, or of the
    ground truth, may hide a goal, a tick or a failure: the action that ran is left out. So is one during which numbers
    of the executive's messages are missing, as in a damaged chunk, or out of order, as with a clock that was set back.

    Args:
      path: Recording of a run.
      domain: Domain of the recorded robot.

    Attributes:
      episodes: Name of the duration model's data set, and the episode.
      left_out: Number of messages that could not be decoded, or are missing, by key.
      reasons: Their reasons, by key.
      sensors: Keys of sensors among them.
      damage: Of the file.

    Raises:
      UsageError: The file is no recording, or of another robot's run.
    """

    def __init__(self, path: Path, domain: Domain) -> None:
        self.path = path
        self.episodes: list[tuple[str, Episode]] = []
        self.left_out: Counter[str] = Counter()
        self.reasons: defaultdict[str, set[str]] = defaultdict(set)
        self.sensors: set[str] = set()
        self.damage = DamageReport()
        self._decider: str | None = None  # executive of the newest decision
        self._numbers: dict[tuple[str, str], int] = {}  # of the newest message, by key and sender
        truth = (name for name, topic in TOPICS.items() if topic.source == "simulator")
        self._sensor_types = frozenset(TOPICS[name].type for name in domain.sensors)
        self._types = self._sensor_types | {*READ, *(TOPICS[name].type for name in truth)}
        self._read(domain)

    def _read(self, domain: Domain) -> None:
        extractor, moved_unseen = EpisodeExtractor(domain), False
        for message in self._messages():
            moved_unseen |= message is None
            found = () if message is None else self._found(extractor, message)
            self.episodes += [(name, replace(e, work_j=None) if moved_unseen else e) for name, e in found]
            if isinstance(message, ActionFinished):
                moved_unseen = False

    def _found(self, extractor: EpisodeExtractor, message: Message) -> list[tuple[str, Episode]]:
        """Episodes that a message ends."""
        try:
            return extractor.read([message])[len(self.episodes) :]
        except UsageError as error:  # knows no file
            raise UsageError(f"{self.path}: {error}") from None

    def _messages(self) -> Iterator[Message | None]:
        """Messages in the order in which they were published; None for a sensor's that is left out."""
        recording = open_recording(self.path)
        messages = sorted(recording.messages(), key=lambda m: m.publish_ns)
        self.damage = recording.damage
        for recorded in messages:
            kind = type_of(recorded.ros_type)
            if kind is None or kind not in self._types:
                continue
            if kind in READ and not self._follows(recorded):
                yield from FORGOTTEN
            message = decode(kind, recorded.data)
            if isinstance(message, Subgoals) and self._is_of_another(recorded):
                yield from FORGOTTEN
            if not isinstance(message, Rejected):
                yield message
            else:
                yield from self._substitutes(recorded, kind, message)

    def _follows(self, recorded: Recorded) -> bool:
        """Whether no message of its key and sender is missing before this one; counts those that are."""
        identity, number = (recorded.key, recorded.sender), recorded.sequence
        before = self._numbers.get(identity, number - 1)
        self._numbers[identity] = number
        if not recorded.sender or number == before + 1:  # the numbers of several senders mean nothing
            return True
        self.left_out[recorded.key] += max(1, number - before - 1)
        self.reasons[recorded.key].add(MISSING if number > before else DISORDERED)
        return False

    def _is_of_another(self, recorded: Recorded) -> bool:
        """Whether another executive decides now, as after a crash: its action may have number and goal of the last."""
        before, self._decider = self._decider, recorded.sender
        return before not in (None, recorded.sender)

    def _substitutes(self, recorded: Recorded, kind: type[Message], rejected: Rejected) -> tuple[Message | None, ...]:
        """What is read in place of a message that is left out."""
        self.left_out[recorded.key] += 1
        self.reasons[recorded.key].add(rejected.reason)
        if kind not in self._sensor_types:
            return FORGOTTEN
        self.sensors.add(recorded.key)
        return (None,)
