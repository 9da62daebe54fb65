"""Warns of episodes that were simulated with another source of their robot than today's: models learn that one."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

from tailor.models.episodes.manifest import read_manifest
from tailor.models.episodes.sources import source_files
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.schemas.installed.changed_source import changed_files
from tailor.schemas.installed.episode_files import episode_files
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.learning.training_request import TrainingRequest, data_sets

NAMED = 3  # folders, and files, that the warning names


def changed_episodes_warning(request: TrainingRequest) -> str:
    """One line that names the data sets and what changed since; empty if nothing did, or if they do not state it.

    Whether a change matters is not judged here: `tailor models check` runs some episodes again.

    Args:
      request: What is to be trained; training reports what is wrong with its data sets.
    """
    try:
        folders = list(itertools.chain(*data_sets(request).values()))
        changed = _changed(folders, request.robot)
    except (UsageError, SyntaxError, ValueError):  # the others: a file of the robot's package cannot be parsed
        return ""
    if not changed:
        return ""
    files = sorted({file for each in changed.values() for file in each})
    return (
        f"{abbreviated(list(map(str, changed)), NAMED)}: simulated with another {abbreviated(files, NAMED)}, expected "
        f"today's where that moves the robot: `tailor models check {request.robot}` tells it of the trained models, "
        "and `tailor gather` into an emptied folder makes others"
    )


def _changed(folders: Sequence[Path], robot: str) -> dict[Path, list[str]]:
    """Changed files of those data sets of the robot that have any."""
    if robot not in robot_names():
        return {}
    today = episode_files(spec_of_robot(robot).name)
    manifests = {folder: read_manifest(folder) for folder in folders}
    found = {
        folder: changed_files({"sources": [each], "source_files": source_files([each])}, today)
        for folder, each in manifests.items()
        if each["robot"] == robot  # training refuses the others
    }
    return {folder: files for folder, files in found.items() if files}
