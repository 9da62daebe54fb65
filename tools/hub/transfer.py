"""Push and pull: models and data sets to and from a repository of the hub, or a folder of the same layout.

Everything is written into a temporary folder first and then moved; whoever interrupts it keeps what he had.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tailor.executive.robot_models import check_fit
from tailor.models.cards.card import card_path
from tailor.models.cards.checks import check_place
from tailor.models.cards.model_files import read_model
from tailor.models.episodes.episodes import read_data_set
from tailor.models.episodes.manifest import MANIFEST
from tailor.models.export.zoo_writer import replace_model
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names
from tailor.tools.cli.output_folders import temporary_beside
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.hub.client import upload
from tailor.tools.hub.fetching import fetched
from tailor.tools.hub.folders import DATA_FILES, MODEL_FILES
from tailor.tools.hub.place import Place
from tailor.tools.learning.model_folders import target_zoo


def push(write: Callable[[Path], None], place: Place, kind: str, public: bool) -> str:
    """Write a folder and move or upload it; returns where it is now.

    Args:
      write: Fills an empty folder.
      place: A repository, or a folder that does not exist.
      kind: "model" or "dataset".
      public: Whether everyone may read a new repository.

    Raises:
      UsageError: Nothing to push, the folder exists, or the hub refuses.
    """
    if place.folder is not None and os.path.lexists(place.folder):
        raise UsageError(f"{place.folder}: exists, expected a new folder")
    with temporary_beside(place.folder or Path(tempfile.gettempdir()) / "push") as temporary:
        write(temporary)
        if place.folder is None:
            return upload(temporary, str(place.repository), kind, public)
        temporary.rename(place.folder)
    return str(place.folder)


def pull_models(place: Place, revision: str | None, zoo: Path | None, replace: bool) -> list[Path]:
    """Get models, check each, and put them into a zoo; returns their paths there.

    Args:
      place: Where `push` put them.
      revision: Branch, tag or commit of a repository; None: the newest.
      zoo: Folder of models; None: as `tailor train` chooses it.
      replace: Whether models of the robot in the zoo are replaced, and those removed that were not pulled.

    Raises:
      UsageError: Nothing there, a file differs from its checksum, a model is damaged or unsuitable, or the zoo has
        models of that robot.
    """
    with temporary_beside((zoo or Path(tempfile.gettempdir())) / "pull") as temporary:
        files = fetched(place, "model", revision, MODEL_FILES, temporary)
        models = [file for file in files if file.suffix == ".onnx" and len(file.parts) == 3]
        robots = {model.parts[0] for model in models}
        if len(robots) != 1:
            raise UsageError(f"{place}: models of {', '.join(sorted(robots)) or 'no robot'}, expected those of one")
        robot = robots.pop()
        with _errors_of(place, temporary):
            for model in models:
                _check(temporary / model)
        target = target_zoo(zoo, robot)
        _install(temporary, models, target, robot, replace)
    return [target / model for model in models]


def pull_data(place: Place, revision: str | None, data: Path, replace: bool) -> list[Path]:
    """Get data sets and put them into a folder; returns their folders there.

    Raises:
      UsageError: Nothing there, a file differs from its checksum, a manifest or a part is damaged or too large, or
        the folder has a data set of that name, or something else, which `replace` does not remove.
    """
    with temporary_beside(data) as temporary:
        files = fetched(place, "dataset", revision, DATA_FILES, temporary)
        names = sorted({file.parts[0] for file in files if file.name == MANIFEST and len(file.parts) == 2})
        if not names:
            raise UsageError(f"{place}: no data sets, expected what `tailor models push --data DIR` wrote")
        with _errors_of(place, temporary):
            for name in names:
                read_data_set(temporary / name)  # whole, as training does
        existing = [data / name for name in names if os.path.lexists(data / name)]
        _refuse([path for path in existing if not replace])
        if strange := [path for path in existing if not (path / MANIFEST).is_file()]:  # the pushed names are another's
            raise UsageError(f"{strange[0]}: is no data set, expected one where --replace is to remove it")
        data.mkdir(parents=True, exist_ok=True)
        for name in names:
            _swap(temporary / name, data / name)
    return [data / name for name in names]


@contextmanager
def _errors_of(place: Place, temporary: Path) -> Iterator[None]:
    """Errors name the place in which a file is wrong, not the folder that is removed now."""
    try:
        yield
    except UsageError as error:
        raise UsageError(str(error).replace(str(temporary), str(place))) from None


def _check(model: Path) -> None:
    """Raise UsageError if a model is damaged, another than its place says, or none that its robot could use."""
    card, robot, action = load_model(model).card, model.parts[-3], model.parts[-2]
    check_place(card, f"{robot}/{action}/{model.stem}", model)
    if robot in robot_names():
        check_fit(robot, f"{action}/{model.stem}", card, model)


def _install(source: Path, models: list[Path], zoo: Path, robot: str, replace: bool) -> None:
    """Put models with their cards into a zoo, pair by pair."""
    old = {path.relative_to(zoo) for path in (zoo / robot).glob("*/*.onnx")}
    _refuse([zoo / path for path in sorted(old) if not replace])
    for model in models:
        replace_model(zoo / model, *read_model(source / model))
    for model in old - set(models):
        card_path(zoo / model).unlink(missing_ok=True)
        (zoo / model).unlink()  # last: a model without a card is found and removed by the next pull


def _refuse(existing: list[Path]) -> None:
    if existing:
        raise UsageError(f"{abbreviated(list(map(str, existing)), 1)}: exists, expected an empty place, or --replace")


def _swap(new: Path, old: Path) -> None:
    """Put a folder in the place of another one, which is removed last."""
    aside = old.with_name(f".{old.name}.replaced")
    if aside.exists() and not old.exists():
        aside.rename(old)  # an earlier swap was killed here
    _remove(aside)
    if os.path.lexists(old):
        old.rename(aside)
    new.rename(old)
    _remove(aside)


def _remove(folder: Path) -> None:
    """Remove a folder; of a symbolic link the link, not what it points to."""
    if folder.is_symlink():
        folder.unlink()
    else:
        shutil.rmtree(folder, ignore_errors=True)
