"""Warns at start of models whose episodes were simulated with another source than today's."""

from __future__ import annotations

from pathlib import Path

from tailor.models.cards.card import read_card
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder, spec_of
from tailor.schemas.installed.changed_source import changed_files
from tailor.schemas.installed.episode_files import episode_files
from tailor.tools.cli.word_lists import abbreviated

NAMED = 3  # files that the warning names


def stale_models_warning(domain: str, zoo: str) -> str:
    """One line that names what changed; empty if nothing did, or if the cards do not state their source.

    Whether the changes matter is not judged here: `tailor models check` runs some episodes again.

    Args:
      domain: Name of the domain.
      zoo: Folder of models; empty: that of the robot's package.
    """
    robot = spec_of(domain).robot
    folder = (Path(zoo) if zoo else models_folder(robot)) / robot
    today, changed = episode_files(domain), {}
    for path in sorted(folder.glob("*/*.card.json")):
        try:
            changed[path.parent.name] = changed_files(read_card(path)["episodes"], today)
        except UsageError:
            continue  # the executive refuses it and reports why
    stale = [name for name, files in changed.items() if files]
    files = sorted({file for each in changed.values() for file in each})
    if not stale:
        return ""
    return (
        f"models of {', '.join(stale)} were learned with another {abbreviated(files, NAMED)}: "
        f"`tailor models check {robot}` states whether they are stale"
    )
