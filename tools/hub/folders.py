"""Folders as the hub takes them: the files of a zoo or of data sets, a card, checksums."""

from __future__ import annotations

import shutil
from pathlib import Path

from tailor.models.cards.card import MAX_CARD_BYTES, MAX_MODEL_BYTES, card_path
from tailor.models.cards.checks import check_place
from tailor.models.cards.model_files import read_model
from tailor.models.episodes.episodes import read_data_set
from tailor.models.episodes.manifest import MANIFEST
from tailor.models.episodes.part_reader import parts_of
from tailor.models.export.zoo_writer import replace_model
from tailor.models.runtime import load_model
from tailor.schemas.errors import UsageError
from tailor.tools.hub.checksums import CHECKSUMS, MAX_BYTES, write_checksums
from tailor.tools.hub.data_card import data_card
from tailor.tools.hub.licence import licence_of
from tailor.tools.hub.model_card import model_card

README = "README.md"
MAX_MANIFEST_BYTES = 10_000_000  # of what is read whole: one of thousands of recordings has less than 1 MB
MAX_PART_BYTES = 1_000_000_000  # a part holds some megabytes
# What is pulled: patterns of files, and the most bytes of each such file.
MODEL_FILES = {"*/*/*.onnx": MAX_MODEL_BYTES, "*/*/*.card.json": MAX_CARD_BYTES, CHECKSUMS: MAX_BYTES}
DATA_FILES = {"*/part-*.parquet": MAX_PART_BYTES, f"*/{MANIFEST}": MAX_MANIFEST_BYTES, CHECKSUMS: MAX_BYTES}


def write_models(zoo: Path, robot: str, licence: str | None, folder: Path) -> None:
    """Write a robot's models, each checked, as a folder of the hub.

    Args:
      zoo: Folder of models.
      robot: Name of the robot.
      licence: SPDX id; None: that of the robot's package.
      folder: An empty folder.

    Raises:
      UsageError: There are no models of the robot, or one is damaged or another than its place says.
    """
    models = sorted(model for model in (zoo / robot).glob("*/*.onnx") if model.name[0] != ".")  # a copy of macOS, say
    if not models:
        raise UsageError(f"{zoo / robot}: no action models, expected ACTION/duration.onnx (`tailor train` writes them)")
    cards = [load_model(model).card for model in models]
    for model, card in zip(models, cards, strict=True):
        check_place(card, f"{robot}/{model.parent.name}/{model.stem}", model)
    files = [file.relative_to(zoo) for model in models for file in (model, card_path(model))]
    for model in models:
        replace_model(folder / model.relative_to(zoo), *read_model(model))
    (folder / README).write_text(model_card(robot, cards, licence or licence_of(robot)), encoding="utf-8")
    write_checksums(folder, files)


def write_data(data: Path, licence: str | None, folder: Path) -> None:
    """Write the data sets in the sub-folders of a folder as a folder of the hub; hidden ones are left out.

    Raises:
      UsageError: There are no data sets, they are of several robots, or a manifest or a part is damaged.
    """
    sets = sorted(manifest.parent for manifest in data.glob(f"*/{MANIFEST}") if manifest.parent.name[0] != ".")
    manifests, rows = {}, 0
    for each in sets:
        read = read_data_set(each)
        manifests[each.name], rows = read.manifest, rows + sum(len(episode.ticks) for episode in read.episodes)
    robots = sorted({manifest["robot"] for manifest in manifests.values()})
    if len(robots) != 1:
        found = ", ".join(robots) or "none"
        raise UsageError(f"{data}: data sets of {found}, expected those of one robot (`tailor gather` writes them)")
    parts = [part for each in sets for part in parts_of(each)]
    files = [file.relative_to(data) for file in (*parts, *(each / MANIFEST for each in sets))]
    _copy(data, files, folder)
    card = data_card(robots[0], manifests, rows, licence or licence_of(robots[0]))
    (folder / README).write_text(card, encoding="utf-8")
    write_checksums(folder, files)


def _copy(source: Path, files: list[Path], target: Path) -> None:
    for file in files:
        (target / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source / file, target / file)
