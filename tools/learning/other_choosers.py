"""Warns of calibrating episodes that other models chose than those that are trained: they correct no interval of these.

The models that chose are those in the zoo, or were: then their cards name the calibrating episodes already.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.models.cards.card import Card, read_card
from tailor.models.episodes.manifest import read_manifest
from tailor.models.episodes.part_reader import parts_sha256
from tailor.models.episodes.sources import CALIBRATES
from tailor.schemas.errors import UsageError
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.learning.gathering.choosing_models import models_hash
from tailor.tools.learning.training_request import TrainingRequest, data_sets

NAMED = 3  # data sets that the warning names
MODELS = "models_sha256"  # entry of a manifest: of those that chose


def other_choosers_warning(request: TrainingRequest) -> str:
    """One line that names the data sets; empty if there are none, or if the zoo has no model to compare with.

    Args:
      request: What is to be trained; training reports what is wrong with its data sets.
    """
    found: dict[Path, str] = {}
    try:
        for action, folders in data_sets(request).items():
            manifests = {folder: read_manifest(folder) for folder in folders}
            calibrating = [folder for folder, manifest in manifests.items() if manifest.get(CALIBRATES)]
            if calibrating and (reason := _reason(request, action, manifests, calibrating)):
                found.update(dict.fromkeys(calibrating, reason))
    except (UsageError, OSError, SyntaxError, ValueError):  # the last two: a file of the robot's package is no Python
        return ""
    if not found:
        return ""
    named, reason = abbreviated(list(map(str, found)), NAMED), next(iter(found.values()))
    return (
        f"{named}: {reason}, expected choices of the models that are trained, whose intervals they correct: train "
        "without them, `tailor gather … --calibrates` with those models, train again"
    )


def _reason(
    request: TrainingRequest, action: str, manifests: Mapping[Path, Mapping[str, Any]], calibrating: Sequence[Path]
) -> str:
    """Why the calibrating episodes are no choices of the models that are trained; empty if nothing speaks for it."""
    choosers = {manifests[folder].get(MODELS) for folder in calibrating}
    if len(choosers) > 1:
        return f"{len(choosers)} different models chose"
    place = request.zoo / request.robot / action / "duration.card.json"
    if not place.is_file():
        return ""
    card = read_card(place)
    if (learned := _learned(card)) and learned != _sha256_of_learned(manifests):
        return f"models of other episodes chose (those of {place.parent})"
    known = {source.get("sha256") for source in card["episodes"].get("sources", ())}
    if known >= set(map(parts_sha256, calibrating)) or models_hash(request.robot, str(request.zoo)) in choosers:
        return ""
    return f"other models chose than those in {request.zoo / request.robot}"


def _learned(card: Card) -> list[str]:
    """Hashes of the data sets that a model has learned durations from."""
    return [str(source.get("sha256")) for source in card["episodes"].get("sources", ()) if not source.get(CALIBRATES)]


def _sha256_of_learned(manifests: Mapping[Path, Mapping[str, Any]]) -> list[str]:
    """The same of the model that is trained; from data sets of several objects none is learned beside others."""
    alone: Sequence[Path] = [folder for folder, each in manifests.items() if not each.get("objects")] or [*manifests]
    return [parts_sha256(folder) for folder in alone if not manifests[folder].get(CALIBRATES)]
