"""Whether two data sets hold the same episodes, or others from the same starts: tests must be of unseen ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from tailor.models.episodes.sources import BESIDE_ONE, RUN_NUMBERS
from tailor.schemas.errors import UsageError


class Episodes(Protocol):
    """A `DataSet`, which imports this module."""

    @property
    def manifest(self) -> Mapping[str, Any]:
        """Its manifest."""
        ...

    @property
    def episodes(self) -> Sequence[Any]:
        """Its episodes, each an `Episode`."""
        ...


def check_distinct(one: Episodes, other: Episodes) -> None:
    """Check that what is held out of both data sets is unseen.

    Raises:
      UsageError: They hold the same episodes or tasks; or runs of one start and noise, as other models or another
        horizon choose in them, whose episodes are alike.
    """
    action, seed = one.manifest["action"], one.manifest.get("seed")
    if _draw(one.manifest) == _draw(other.manifest) is not None:
        raise UsageError(f"two data sets hold the same episodes of {action} (seed {seed}), expected each once")
    shared = _runs(one) & _runs(other)
    if shared and one.manifest.get("domain") == other.manifest.get("domain") and seed == other.manifest["seed"]:
        runs = "1 run" if len(shared) == 1 else f"{len(shared)} runs"
        raise UsageError(
            f"two data sets hold {action} of {runs} from the same starts (seed {seed}), "
            "expected each from starts of its own (`tailor gather` with another --seed)"
        )
    ours = {episode.ticks.tobytes() for episode in one.episodes}
    same = sum(episode.ticks.tobytes() in ours for episode in other.episodes)
    if same:
        raise UsageError(f"two data sets hold {same} same episodes of {action}, expected each once")


def _draw(manifest: Mapping[str, Any]) -> list[Any] | None:
    """The manifest entries that determine the tasks of a data set; None if they were not drawn from a seed.

    Random tasks beside an object are those without it: the object is drawn after them.
    """
    if manifest.get("seed") is None:
        return None
    source = str(manifest.get("source")).removesuffix(BESIDE_ONE)
    return [source, *(manifest.get(key) for key in ("seed", "stream", "scenarios", "models_sha256", "profile"))]


def _runs(data: Episodes) -> set[int]:
    """Numbers of the simulated runs that episodes are from; empty if they are not from whole runs.

    The number determines the seed of a run, whatever the scenarios: those of one seed share noise, and some the start.
    """
    drawn = data.manifest.get("on_policy") and data.manifest.get("seed") is not None
    return {episode.number // RUN_NUMBERS for episode in data.episodes} if drawn else set()
