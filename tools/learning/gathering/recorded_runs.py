"""Gathers episodes from recordings: that is how the models of a real robot are learned."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.models.episodes.episodes import Episode
from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering.recorded_episodes import RecordedEpisodes
from tailor.tools.learning.gathering.run_data_sets import modelled_actions, prepare, write
from tailor.tools.recordings.damage_notice import notice


@dataclass(frozen=True, slots=True)
class Extracted:
    """What recordings gave.

    Attributes:
      counts: Number of episodes by action.
      left_out: A line for each damaged recording, and for each topic of one with messages that could not be used.
    """

    counts: Mapping[str, int]
    left_out: tuple[str, ...]


def extract_from_recordings(domain: str, folder: Path, recordings: Sequence[Path]) -> Extracted:
    """Extract data sets from recordings.

    Messages that cannot be decoded, e.g. of values that are not finite, are left out, and so are actions during which
    some are missing: see `RecordedEpisodes`.

    Raises:
      UsageError: A file is not a recording of an executive's run, none holds a finished action, two hold the same
        one, or the folder holds episodes already; nothing is written then.
    """
    robot = domains.load(domain)
    read = [RecordedEpisodes(path, robot) for path in recordings]
    left_out = tuple(line for each in read for line in _lines(each))
    cut = [each.episodes for each in read]
    if not any(cut):
        without = "".join(f"; {line}" for line in left_out)
        raise UsageError(
            f"{', '.join(map(str, recordings))}: no finished action, expected the recording of a run{without}"
        )
    _check_distinct(cut, recordings)
    counts = Counter(action for one in cut for action, _ in one)
    prepare(domain, folder, sorted(counts), _about(read), recordings, resume=False)
    number = 0
    for one in cut:
        numbered = [(action, replace(e, number=number + k)) for k, (action, e) in enumerate(one)]
        write(domain, folder, f"{number:06d}", numbered)
        number += len(one)
    return Extracted({action: counts[action] for action in modelled_actions(domain)}, left_out)


def _about(read: Sequence[RecordedEpisodes]) -> dict[str, Any]:
    """Entries of the manifests."""
    left_out = {each.path.name: dict(each.left_out) for each in read if each.left_out}
    names = [each.path.name for each in read]
    return {"source": "recordings", "recordings": names, **({"left_out": left_out} if left_out else {})}


def _lines(read: RecordedEpisodes) -> Iterator[str]:
    if damage := notice(read.path, read.damage):
        yield damage
    for key, count in read.left_out.items():
        messages = f"{count} message" if count == 1 else f"{count} messages"
        lost = "" if key in read.sensors else ", with the action that ran"
        yield f"{read.path}: left out {messages} of {key}{lost} ({', '.join(sorted(read.reasons[key]))})"


def _check_distinct(cut: Sequence[Sequence[tuple[str, Episode]]], recordings: Sequence[Path]) -> None:
    """Raise UsageError if two recordings, whatever their names, hold the same episode: test and training share it."""
    known: dict[tuple[str, bytes], Path] = {}
    for path, one in zip(recordings, cut, strict=True):
        keys = [(action, episode.ticks.tobytes()) for action, episode in one]
        for key in keys:
            if key in known:
                raise UsageError(f"{path}: holds the same {key[0]} as {known[key]}, expected each run once")
        known |= dict.fromkeys(keys, path)
