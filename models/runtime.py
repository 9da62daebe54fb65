"""Loads and checks ONNX action models.

A model is used only if its bytes, its card and its predictions agree: onnxruntime does not detect a flipped bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.model_bounds import ModelBounds, model_bounds
from tailor.models.cards.card import KINDS, SUCCESS_KINDS, UNITS, Card, card_path
from tailor.models.cards.checks import check_identity, check_place
from tailor.models.cards.model_files import read_model
from tailor.models.features.spaces import feature_spaces
from tailor.models.inference import OnnxDuration, OnnxModel, OnnxSuccess, open_session, run
from tailor.schemas.errors import UsageError

ZOO = Path(__file__).resolve().parent / "zoo"
BESIDE = "_beside"  # end of the name of durations beside objects, after that of the same action's without
GOLDEN_TOLERANCE = 1e-4  # seconds, joules or probability: the tolerance of export (learning.md)
GOLDEN_SHARE = 1e-5  # of the largest value, if that is more: graphs compute in single precision


def load_model(model: Path | str, zoo: Path | None = None) -> OnnxModel:
    """Load and check one model.

    Args:
      model: Path of the ONNX file, or name in the zoo, as "agilo/goToPose/duration".
      zoo: Folder of models, None for the one that ships.

    Raises:
      UsageError: The file or its card is missing or damaged, or they do not agree, or it is another model than the name
        says; the message names both values.
    """
    path = model if isinstance(model, Path) else _in_zoo(model, zoo or ZOO)
    content, card = read_model(path)
    if isinstance(model, str):
        check_place(card, model, path)
    session = _session(content, path)
    check_identity(_metadata(session, path), session.get_inputs()[0].shape, card, path)
    bounds = model_bounds(content, str(card["features"]), _number_of_features(card, path))
    loaded = _wrapped(session, card, path, bounds)
    _check_golden(loaded, card, path)
    return loaded


def load_robot(robot: str, zoo: Path | None = None) -> tuple[dict[str, OnnxDuration], dict[str, OnnxSuccess]]:
    """Load all models of a robot: durations (and energies) and successes by "action/kind".

    Args:
      robot: Folder in the zoo.
      zoo: Folder of models, None for the one that ships.

    Returns:
      Models of durations and energies, and models of success.

    Raises:
      UsageError: No such robot in the zoo, or a model fails its checks.
    """
    folder = (zoo or ZOO) / robot
    if not folder.is_dir() or folder.parent != (zoo or ZOO):
        robots = ", ".join(sorted(p.name for p in (zoo or ZOO).glob("*") if p.is_dir())) or "none"
        make = f"`tailor gather {robot}` and `tailor train {robot}` make them"
        raise UsageError(f"no action models for robot '{robot}' in {zoo or ZOO} (robots there: {robots}); {make}")
    durations: dict[str, OnnxDuration] = {}
    successes: dict[str, OnnxSuccess] = {}
    for name in _names(folder):
        model = load_model(f"{robot}/{name}", zoo)
        if isinstance(model, OnnxDuration):
            durations[name] = model
        elif isinstance(model, OnnxSuccess):
            successes[name] = model
    _check_beside(durations, folder)
    return durations, successes


def _check_beside(durations: Mapping[str, OnnxDuration], folder: Path) -> None:
    """Raise UsageError if durations beside objects are of other episodes than those without: their means differ."""
    for name in (name for name in durations if name.endswith(BESIDE)):
        own = durations.get(name.removesuffix(BESIDE))
        if own is None or own.card["episodes"].get("sha256") != durations[name].card["episodes"].get("sha256"):
            raise UsageError(
                f"{folder / name}.onnx: learned from other episodes than {name.removesuffix(BESIDE)}, "
                "expected the same (`tailor train` makes both); it may be removed"
            )


def _names(folder: Path) -> list[str]:
    """Every "action/kind" that has a model or a card; one without the other is an error when loading."""
    files = {f"{p.parent.name}/{p.name.split('.')[0]}" for kind in KINDS for p in folder.glob(f"*/{kind}.*")}
    return sorted(files)


def _in_zoo(name: str, zoo: Path) -> Path:
    parts = name.split("/")
    if len(parts) != 3 or parts[2] not in KINDS or any(part in ("", ".", "..") for part in parts):
        raise UsageError(f"'{name}' names no model (expected ROBOT/ACTION/KIND, KIND one of: {', '.join(KINDS)})")
    return zoo.joinpath(*parts[:2], f"{parts[2]}.onnx")


def _session(content: bytes, path: Path) -> Any:
    try:
        return open_session(content)
    except Exception as error:  # onnxruntime's exceptions have no common base
        raise UsageError(f"{path}: not a model that onnxruntime can run ({str(error).splitlines()[0]})") from None


def _metadata(session: Any, path: Path) -> dict[str, str]:
    try:
        texts: dict[str, str] = session.get_modelmeta().custom_metadata_map
    except UnicodeDecodeError:
        raise UsageError(f"{path}: its metadata are no UTF-8, expected a model that Tailor made") from None
    return texts


def _number_of_features(card: Card, path: Path) -> int:
    """Number of features; that of the card alone if the package that declares the feature space is not installed."""
    space, units = feature_spaces().get(card["features"]), card.get("feature_units")
    if space is None:
        return len(units or ())
    if units is not None and len(units) != len(space.features):
        raise UsageError(
            f"{card_path(path)}: card's feature_units has {len(units)} entries, "
            f"expected {len(space.features)} by its features '{space.name}'"
        )
    return len(space.features)


def _wrapped(session: Any, card: Card, path: Path, bounds: ModelBounds | None) -> OnnxModel:
    if card["kind"] in UNITS:
        output_min, output_max = card["output_range"]
        return OnnxDuration(session, card, float(output_min), float(output_max), bounds)
    if card["kind"] in SUCCESS_KINDS:
        return OnnxSuccess(session, card, float(card["threshold"]), bounds)
    raise UsageError(f"{path}: kind '{card['kind']}' is unknown (expected one of: {', '.join(KINDS)})")


def _check_golden(model: OnnxModel, card: Card, path: Path) -> None:
    """Compare predictions of the golden examples with the card; also warms up the session."""
    golden = card["golden"]
    arguments = np.array(golden["arguments"], np.float64)
    for rows in (arguments, arguments[:1]):  # the executive predicts for one row, too
        outputs = run(model.session, rows, len(card["outputs"]))
        if isinstance(outputs, str):
            raise UsageError(f"{path}: {outputs}")
    largest = max(abs(value) for name in card["outputs"] for value in golden[name])
    tolerance = max(GOLDEN_TOLERANCE, GOLDEN_SHARE * largest)
    for name, values in zip(card["outputs"], _predictions(model, arguments), strict=True):
        expected = np.array(golden[name], np.float64)
        off = np.abs(values - expected)
        if not (off <= tolerance).all():
            worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
            raise UsageError(
                f"{path}: golden example {worst} gives {name} = {values[worst]:.6g}, "
                f"expected {expected[worst]:.6g} by its card"
            )


def _predictions(model: OnnxModel, arguments: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """All outputs of a model, in the order of its card."""
    if isinstance(model, OnnxSuccess):
        return (model.probability(arguments),)
    return model.interval(arguments) if model.calibrated else model.predict(arguments)
