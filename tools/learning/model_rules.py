"""Rules of `tailor models rules`: of one of a model's trees, or of a tree distilled from the model.

The first line gives their mean difference from the model, and R², over its episodes.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.tree_boxes import TreeBoxes, tree_boxes
from tailor.models.cards.card import UNITS, Card
from tailor.models.inference import OnnxDuration, OnnxSuccess
from tailor.models.rules import leaf_rules
from tailor.models.rules.model_queries import distilled_duration, distilled_success, random_arguments, space_of
from tailor.models.rules.rule_text import duration_rules, success_rules
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]
Model = OnnxDuration | OnnxSuccess

DISTILLED = 0  # in place of a tree's number
RANDOM_ARGUMENTS = 3000  # to compare on, if there are no episodes


def rules(model: Model, file: Path, tree: int | None, data: Path | None) -> str:
    """A model as rules, with a first line that compares both.

    Args:
      model: The loaded model.
      file: Its ONNX file.
      tree: Number of the tree to print, from 1; DISTILLED; or None: the only tree, or else the distilled one.
      data: Folder with a data set per action, to compare on at its first ticks; None for data/ROBOT.

    Raises:
      UsageError: The model has no such tree.
    """
    quantities, unit = space_of(model.card).features, UNITS.get(model.card["kind"], "")
    arguments, where = _arguments(model.card, data)
    features, whole = space_of(model.card)(arguments), _predictions(model, arguments)
    boxes = tree_boxes(file.read_bytes(), len(quantities))
    if tree is None:
        tree = 1 if boxes is not None and len(boxes.first) == 1 else DISTILLED
    if tree == DISTILLED:
        lines, predictions = _distilled(model, features)
        what = "a tree distilled from it"
    else:
        lines, predictions = _own(model.card, boxes, tree, features)
        what = "its only tree" if boxes and len(boxes.first) == 1 else f"its tree {tree}"
    off = np.abs(predictions - whole)
    mean = f"{np.nanmean(off):.3f} {unit}" if unit else f"{100 * np.nanmean(off):.1f} %"
    faithful = f"differ from the model by {mean} on average, {explained(predictions, whole)}, {where}"
    name = "/".join(model.card[key] for key in ("robot", "action", "kind"))
    return "\n\n".join([f"{name}: {len(lines)} rules of {what}, which {faithful}", *lines])


def tree_number(text: str) -> int:
    """Number of a tree in "bag:3", "forest:3" or "3".

    Raises:
      UsageError: The text has no such number.
    """
    read = re.fullmatch(r"(?:(?:bag|forest):)?([0-9]{1,9})", text)
    if read is None or int(read[1]) < 1:
        raise UsageError(f"--of {text}: expected the number of a tree, from 1, as in bag:3 or forest:3")
    return int(read[1])


def _own(card: Card, boxes: TreeBoxes | None, tree: int, features: NDArray[np.float32]) -> tuple[list[str], Array]:
    if boxes is None:
        raise UsageError(
            f"the model, by learner {card['learner']['name']}, has no trees (--distilled prints one that is like it)"
        )
    quantities, unit = space_of(card).features, UNITS.get(card["kind"], "")
    lines = leaf_rules.rules_of(boxes, tree, quantities, unit)
    return lines, leaf_rules.predictions_of(boxes, tree, features).astype(np.float64)


def _distilled(model: Model, features: NDArray[np.float32]) -> tuple[list[str], Array]:
    quantities, rng = space_of(model.card).features, np.random.default_rng(0)
    if isinstance(model, OnnxDuration):
        tree, _ = distilled_duration(model, rng)
        return duration_rules(tree, quantities, UNITS[model.card["kind"]]), tree.predict(features).astype(np.float64)
    splits, success, _ = distilled_success(model, rng)
    return success_rules(splits, success, quantities), success[splits.leaf_of(features)].astype(np.float64)


def _arguments(card: Card, data: Path | None) -> tuple[Array, str]:
    """Arguments to compare on, and their origin in words."""
    from tailor.tools.learning.known_episodes import folder_of, known_episodes

    episodes = known_episodes(card, data)
    if episodes:
        where = f"over the {len(episodes)} episodes in {folder_of(card, data)}"
        return np.stack([episode.ticks[0] for episode in episodes]), where
    drawn = random_arguments(card, RANDOM_ARGUMENTS, np.random.default_rng(1))
    return drawn, f"over {RANDOM_ARGUMENTS} random arguments"


def _predictions(model: Model, arguments: Array) -> Array:
    return model.predict(arguments)[0] if isinstance(model, OnnxDuration) else model.probability(arguments)


def explained(predictions: Array, whole: Array) -> str:
    """Share of the model's variance that the rules explain, in words: of a constant none is there to explain."""
    finite = np.isfinite(predictions) & np.isfinite(whole)
    if not finite.any() or not np.ptp(whole[finite]):  # the variance of equal values may round to more than 0
        return "without R², as the model predicts one value"
    unexplained = float(np.mean((predictions[finite] - whole[finite]) ** 2)) / float(np.var(whole[finite]))
    return f"R² {1.0 - unexplained:.3f}"
