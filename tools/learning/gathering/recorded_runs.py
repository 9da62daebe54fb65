"""Gathers episodes from recordings: that is how the models of a real robot are learned."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tailor.executive import domains
from tailor.executive.interfaces.domain import Domain
from tailor.models.episodes.episodes import Episode
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import ActionFinished, Contexts, ExecStatus, Message, Subgoals
from tailor.schemas.topics import TOPICS
from tailor.tools.learning.gathering.run_data_sets import modelled_actions, prepare, write
from tailor.tools.lockstep.episode_extraction import EpisodeExtractor

READ = (Subgoals, Contexts, ExecStatus, ActionFinished)  # besides sensors and ground truth


def extract_from_recordings(domain: str, folder: Path, recordings: Sequence[Path]) -> dict[str, int]:
    """Extract data sets from recordings.

    Returns:
      Number of episodes by action.

    Raises:
      UsageError: A file is not a recording of an executive's run, none holds a finished action, two hold the same
        one, or the folder holds episodes already; nothing is written then.
    """
    robot = domains.load(domain)
    cut = [EpisodeExtractor(robot).read(_messages(path, _types_of(robot))) for path in recordings]
    if not any(cut):
        raise UsageError(f"{', '.join(map(str, recordings))}: no finished action, expected the recording of a run")
    _check_distinct(cut, recordings)
    about = {"source": "recordings", "recordings": [path.name for path in recordings]}
    counts = Counter(action for one in cut for action, _ in one)
    prepare(domain, folder, sorted(counts), about, recordings, resume=False)
    number = 0
    for one in cut:
        numbered = [(action, replace(e, number=number + k)) for k, (action, e) in enumerate(one)]
        write(domain, folder, f"{number:06d}", numbered)
        number += len(one)
    return {action: counts[action] for action in modelled_actions(domain)}


def _check_distinct(cut: Sequence[Sequence[tuple[str, Episode]]], recordings: Sequence[Path]) -> None:
    """Raise UsageError if two recordings, whatever their names, hold the same episode: test and training share it."""
    known: dict[tuple[str, bytes], Path] = {}
    for path, one in zip(recordings, cut, strict=True):
        keys = [(action, episode.ticks.tobytes()) for action, episode in one]
        for key in keys:
            if key in known:
                raise UsageError(f"{path}: holds the same {key[0]} as {known[key]}, expected each run once")
        known |= dict.fromkeys(keys, path)


def _types_of(domain: Domain) -> frozenset[type[Message]]:
    """Types of the messages that an extractor may read: the executive's, the robot's sensors, and ground truth."""
    truth = (name for name, topic in TOPICS.items() if topic.source == "simulator")
    return frozenset((*READ, *(TOPICS[name].type for name in (*domain.sensors, *truth))))


def _messages(path: Path, types: Collection[type[Message]]) -> Iterator[Message]:
    """Messages of the given types, in the order in which they were published."""
    from tailor.runtime.recordings.recording import open_recording
    from tailor.schemas.codec import decode
    from tailor.schemas.typesystem import type_of

    for recorded in sorted(open_recording(path).messages(), key=lambda m: m.publish_ns):
        kind = type_of(recorded.ros_type)
        if kind is not None and kind in types:
            message = decode(kind, recorded.data)
            if isinstance(message, Rejected):
                raise UsageError(f"{path}: {recorded.key} number {recorded.sequence}: {message.reason}")
            yield message
