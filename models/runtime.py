"""Loads, checks and runs ONNX action models. The only place that imports onnxruntime.

A model is used only if its bytes, its card and what it computes agree: the runtime itself notices no flipped bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime
from numpy.typing import NDArray

from tailor.models.bounds.model_bounds import ModelBounds, model_bounds
from tailor.models.cards.card import KINDS, MAX_MODEL_BYTES, Card, card_path, read_bytes, read_card, sha256_of
from tailor.models.cards.checks import check_identity, check_place, check_ranges, check_trained_with
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]

ZOO = Path(__file__).resolve().parent / "zoo"
GATE = "refinement/benefit"  # the one model of a robot that is not of an action but of choosing subgoals
GOLDEN_TOLERANCE = 1e-4  # seconds, or probability: what export promises (learning.md)


@dataclass(frozen=True, slots=True)
class OnnxDuration:
    """Predicts how long an action takes, or how much energy: seconds or joules, as its card says."""

    session: Any
    card: Card
    shortest_s: float
    longest_s: float
    bounds: ModelBounds | None = None  # for proofs, where its trees can be read

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        """Mean and standard deviation in seconds (or joules), (n,), of arguments (n, k); NaN where they are invalid."""
        mean, std = self.session.run(None, {"arguments": np.ascontiguousarray(arguments, np.float64)})
        valid = (mean >= self.shortest_s) & (mean <= self.longest_s) & (std >= 0)
        if not valid.all():
            mean, std = np.where(valid, mean, np.nan), np.where(valid, std, np.nan)
        return mean.astype(np.float64), std.astype(np.float64)


@dataclass(frozen=True, slots=True)
class OnnxSuccess:
    """Predicts whether an action succeeds."""

    session: Any
    card: Card
    threshold: float  # the learner calls it a success above this probability of success
    bounds: ModelBounds | None = None  # for proofs, where its trees can be read

    def probability(self, arguments: Array) -> Array:
        """Probability of success, shape (n,), of arguments (n, k); NaN where it is invalid."""
        return _probability(self.session, arguments)


@dataclass(frozen=True, slots=True)
class OnnxGate:
    """Predicts whether refinement would slow an episode down (paper 6.3.2)."""

    session: Any
    card: Card
    threshold: float  # above this risk the greedy choice is kept

    @property
    def input_names(self) -> tuple[str, ...]:
        """Names of the values that it is told, in order."""
        return tuple(argument["name"] for argument in self.card["arguments"])

    @property
    def sequences(self) -> frozenset[tuple[str, ...]]:
        """Kinds of sequences that it was learned for: names of actions, asserted subgoals left out."""
        return frozenset(tuple(names) for names in self.card["sequences"])

    def p_slowdown(self, situations: Array) -> Array:
        """Risk that refining costs time, 0..1, shape (n,), of situations (n, k); NaN where it is invalid."""
        return _probability(self.session, situations)


OnnxModel = OnnxDuration | OnnxSuccess | OnnxGate


def load_model(model: Path | str, zoo: Path | None = None) -> OnnxModel:
    """Load one model by path, or by name in the zoo: "agilo/goToPose/duration".

    Raises:
      UsageError: The file or its card is missing or damaged, or they do not agree; the message names both sides.
    """
    path = model if isinstance(model, Path) else _in_zoo(model, zoo or ZOO)
    card = read_card(card_path(path))
    content = read_bytes(path, MAX_MODEL_BYTES)
    if sha256_of(content) != card["sha256"]:
        raise UsageError(f"{path}: sha256 is {sha256_of(content)[:12]}…, expected {card['sha256'][:12]}… by its card")
    session = _session(content, path)
    check_identity(session.get_modelmeta().custom_metadata_map, session.get_inputs()[0].shape, card, path)
    bounds = model_bounds(content, str(card["features"]), len(card.get("feature_units", ())))
    loaded = _wrapped(session, card, path, bounds)
    _check_golden(loaded, card, path)
    return loaded


def load_robot(
    robot: str, zoo: Path | None = None, declared: Mapping[str, Mapping[str, tuple[float, float]]] | None = None
) -> tuple[dict[str, OnnxDuration], dict[str, OnnxSuccess]]:
    """Load all models of a robot: durations (and energies) and successes by "action/kind".

    Args:
      robot: Folder in the zoo.
      zoo: Another zoo than the one that ships.
      declared: Ranges of arguments that the robot's actions will ask for, by action and argument; a model that has
        seen less is refused.

    Raises:
      UsageError: No such robot in the zoo, or a model cannot be trusted.
    """
    folder = (zoo or ZOO) / robot
    if not folder.is_dir() or folder.parent != (zoo or ZOO):
        known = ", ".join(sorted(p.name for p in (zoo or ZOO).glob("*") if p.is_dir())) or "none"
        raise UsageError(f"no action models for robot '{robot}' in {zoo or ZOO} (robots there: {known})")
    durations: dict[str, OnnxDuration] = {}
    successes: dict[str, OnnxSuccess] = {}
    for name in _names(folder):
        model = load_model(folder / f"{name}.onnx")
        check_place(model.card, f"{robot}/{name}", folder)
        check_ranges(model.card, (declared or {}).get(name.split("/", maxsplit=1)[0], {}), folder / name)
        if isinstance(model, OnnxDuration):
            durations[name] = model
        elif isinstance(model, OnnxSuccess):
            successes[name] = model
    return durations, successes


def load_gate(robot: str, zoo: Path | None, models: Mapping[str, OnnxModel]) -> OnnxGate | None:
    """Load a robot's refinement gate; None where none has been trained.

    Args:
      robot: Folder in the zoo.
      zoo: Another zoo than the one that ships.
      models: The robot's action models by "action/kind": the tree must have been learned with these.

    Raises:
      UsageError: It cannot be trusted, or was learned with other action models.
    """
    path = (zoo or ZOO) / robot / f"{GATE}.onnx"
    if not path.exists() and not card_path(path).exists():
        return None
    model = load_model(path)
    check_place(model.card, f"{robot}/{GATE}", path.parent)
    check_trained_with(model.card, {name: made.card["sha256"] for name, made in models.items()}, path)
    assert isinstance(model, OnnxGate)
    return model


def _names(folder: Path) -> list[str]:
    """Every "action/kind" of which there is a model or a card: one without the other is an error later."""
    files = {f"{p.parent.name}/{p.name.split('.')[0]}" for kind in KINDS for p in folder.glob(f"*/{kind}.*")}
    return sorted(files - {GATE})


def _in_zoo(name: str, zoo: Path) -> Path:
    parts = name.split("/")
    if len(parts) != 3 or parts[2] not in KINDS or any(part in ("", ".", "..") for part in parts):
        raise UsageError(f"'{name}' names no model (expected ROBOT/ACTION/KIND, KIND one of: {', '.join(KINDS)})")
    return zoo.joinpath(*parts[:2], f"{parts[2]}.onnx")


def open_session(content: bytes) -> Any:
    """An inference session that never starts a thread of its own; the runtime's own exceptions come through."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
    options.enable_mem_reuse = False  # 2 us a call: each result has its place, none waits for another's to be free
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.log_severity_level = 3  # errors come as exceptions, too
    return onnxruntime.InferenceSession(content, options, providers=["CPUExecutionProvider"])


def _session(content: bytes, path: Path) -> Any:
    try:
        return open_session(content)
    except Exception as error:  # the runtime's own family has no common base
        raise UsageError(f"{path}: not a model that runs here ({str(error).splitlines()[0]})") from None


def _wrapped(session: Any, card: Card, path: Path, bounds: ModelBounds | None) -> OnnxModel:
    if card["kind"] in ("duration", "energy"):
        shortest, longest = card["output_range"]
        return OnnxDuration(session, card, float(shortest), float(longest), bounds)
    if card["kind"] == "benefit":
        return OnnxGate(session, card, float(card["threshold"]))
    if card["kind"] == "success":
        return OnnxSuccess(session, card, float(card["threshold"]), bounds)
    raise UsageError(f"{path}: kind '{card['kind']}' is unknown (expected one of: {', '.join(KINDS)})")


def _probability(session: Any, arguments: Array) -> Array:
    rows = np.ascontiguousarray(arguments, np.float64)
    (said,) = session.run(None, {"arguments": rows})
    valid = (said >= 0) & (said <= 1) & np.isfinite(rows.sum(axis=1))  # a tree sends NaN somewhere, too
    return np.where(valid, said, np.nan).astype(np.float64)


def _check_golden(model: OnnxModel, card: Card, path: Path) -> None:
    """The model must still compute what it computed when its card was written; warms the session, too."""
    golden = card["golden"]
    arguments = np.array(golden["arguments"], np.float64)
    match model:
        case OnnxDuration():
            found: tuple[Array, ...] = model.predict(arguments)
        case OnnxSuccess():
            found = (model.probability(arguments),)
        case OnnxGate():
            found = (model.p_slowdown(arguments),)
    for name, values in zip(card["outputs"], found, strict=True):
        expected = np.array(golden[name], np.float64)
        off = np.abs(values - expected)
        if not (off <= GOLDEN_TOLERANCE).all():
            worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
            raise UsageError(
                f"{path}: golden example {worst} gives {name} = {values[worst]:.6g}, "
                f"expected {expected[worst]:.6g} by its card"
            )
