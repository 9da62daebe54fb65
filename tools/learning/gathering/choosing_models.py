"""Data sets whose episodes models choose: the models, and their hash in the manifests."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol

from tailor.executive import domains
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.robot_models import check_all_named, load_models
from tailor.models.episodes.manifest import MANIFEST
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.schemas.installed.source import runs_sha256
from tailor.tools.learning.gathering.run_data_sets import modelled_actions, prepare
from tailor.tools.parallel.software import models_sha256

MARKS = ("runs-*.done", "pool-*.json")  # of finished work, beside the data sets of the actions
UNPROVEN = RefinementSettings(certify_checks=0)  # certificates take time and do not change choices


@lru_cache(maxsize=2)
def cached_models(robot: str, zoo: str) -> Models:
    """Models, loaded once per process."""
    return load_models(robot, zoo)


def models_hash(robot: str, zoo: str) -> str:
    """SHA-256 over the models that choose the arguments: other models give other episodes."""
    return models_sha256(cached_models(robot, zoo))


def complete_hash(name: str, zoo: str) -> str:
    """The `models_hash` of models with which the executive of a domain can run.

    Raises:
      UsageError: An action needs a model that there is not. The first run would find out, when manifests name the hash
        already, and refuse better models.
    """
    domain = domains.load(name)
    models = cached_models(domain.robot, zoo)
    try:
        check_all_named(domain, models, UNPROVEN)
    except UsageError as error:
        raise UsageError(f"{zoo or models_folder(domain.robot)}: {error}") from None
    return models_hash(domain.robot, zoo)


class Chosen(Protocol):
    """Data sets of choices by the current models; see `policy_runs.Policy` and `active_episodes.Active`."""

    @property
    def profile(self) -> str:
        """Of the body; empty: the one that ships."""
        ...

    @property
    def domain(self) -> str:
        """Name of the domain."""
        ...

    @property
    def scenarios(self) -> tuple[str, ...]:
        """Where they choose."""
        ...

    @property
    def seed(self) -> int:
        """Of situations and noise."""
        ...

    @property
    def zoo(self) -> str:
        """Folder of the models."""
        ...

    @property
    def folder(self) -> Path:
        """Folder of the data sets."""
        ...


def prepare_chosen(chosen: Chosen, about: dict[str, Any], runs: Sequence[Any], resume: bool) -> None:
    """Create the folders of data sets that models choose; see `prepare`.

    Raises:
      UsageError: See `prepare`; or some runs are marked as finished, but the data set of an action is gone; or an
        action needs a model that there is not.
    """
    actions = modelled_actions(chosen.domain)
    marked = min((path for marks in MARKS for path in chosen.folder.glob(marks)), default=None)
    gone = next((name for name in actions if not (chosen.folder / name / MANIFEST).exists()), None)
    if marked is not None and gone is not None:
        raise UsageError(f"{marked}: {gone}/{MANIFEST} is not there any more, expected both, or another --out")
    entries = {
        **about,
        "seed": chosen.seed,
        "scenarios": list(chosen.scenarios),
        **({"profile": chosen.profile} if chosen.profile else {}),
        "models_sha256": complete_hash(chosen.domain, chosen.zoo),
        "runs_sha256": runs_sha256(chosen.domain),
    }
    prepare(chosen.domain, chosen.folder, actions, entries, runs, resume)
