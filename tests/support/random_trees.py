"""Random bags of model trees over a feature space, with what a loaded model knows of itself: predictions and bounds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.models.bounds.leaf_bounds import LeafBounds
from tailor.models.bounds.model_bounds import ModelBounds
from tailor.models.bounds.tree_boxes import TreeBoxes
from tailor.models.features.spaces import feature_space

RANGES = {  # where the features of the spaces lie, for thresholds to fall within
    "projective": [(0, 0.75), (0, 0.75), (0, 6), (0, np.pi), (-np.pi, np.pi)],
    "projective-turn": [(0, 0.75), (0, 0.75), (0, 6), (0, np.pi), (-np.pi, np.pi), (0, np.pi)],
    "projective-periodic": [
        *[(0, 0.75), (0, 0.75), (0, 6), (0, np.pi), (-np.pi, np.pi)],  # those of "projective"
        *[(0, np.pi), (-np.pi / 2, np.pi / 2)],
    ],
    "straight-drive": [(0, 0.75), (0, 0.75), (0, 6), (0, np.pi), (-np.pi, np.pi), (0, 1)],
    "relative": [(-6, 6), (-4, 4), (-np.pi, np.pi), (0, 0.75), (-np.pi, np.pi), (0, 0.75)],
    "one-obstacle": [
        *[(0, 0.75), (0, 0.75), (0, 6), (0, np.pi), (-np.pi, np.pi)],  # those of "projective"
        *[(-3, 6), (-3, 3), (-0.5, 3), (-0.5, 5), (-0.5, 5), (0, np.pi), (0, np.pi)],
    ],
    "spot-handle": [(0, 3), (0, np.pi), (0, 1), (-1, 1), (-0.5, 1.5), (0, np.pi)],
    "joints": [(0, 1), (0, 1), (0, 3), (-np.pi, np.pi), (-np.pi, np.pi)],
    "joints-lifted-friction": [(-1, 1), (0, 2), (-2, 2), (0, 3), (-1, 1), (-1, 1), (-1, 1), (-1, 1), (0, 2), (0, 2)],
}


@dataclass
class Trees:
    """Predicts as an ONNX model of the same trees would, in single precision."""

    space: str
    boxes: TreeBoxes
    success: bool = False

    @classmethod
    def random(
        cls, seed: int, space: str = "projective", trees: int = 3, depth: int = 4, success: bool = False
    ) -> Trees:
        rng = np.random.default_rng(seed)
        parts = [_tree(rng, RANGES[space], depth) for _ in range(trees)]
        lower, upper = (np.concatenate([part[k] for part in parts]).astype(np.float32) for k in range(2))
        slopes = rng.normal(0, 0 if success else 1.0, lower.shape).astype(np.float32)
        low = (rng.uniform(0, 1, len(lower)) if success else rng.uniform(2, 5, len(lower))).astype(np.float32)
        high = low if success else low + rng.uniform(0.5, 4, len(lower)).astype(np.float32)
        intercept = low if success else rng.uniform(3, 7, len(lower)).astype(np.float32)
        first = np.cumsum([0] + [len(part[0]) for part in parts[:-1]])
        spread = rng.uniform(0, 1, len(low)).astype(np.float32) if trees == 1 and not success else None
        return cls(space, TreeBoxes(first, lower, upper, slopes, intercept, low, high, spread), success)

    @property
    def bounds(self) -> ModelBounds:
        return ModelBounds(self.space, LeafBounds(self.boxes))

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        boxes, features = self.boxes, feature_space(self.space)(arguments)
        inside = np.ones((len(features), len(boxes.low)), bool)
        for j in range(features.shape[1]):
            inside &= (features[:, j, None] > boxes.lower[:, j]) & (features[:, j, None] <= boxes.upper[:, j])
        leaf = np.stack([np.argmax(part, axis=1) + at for at, part in self._parts(inside)], axis=1)
        said = (features[:, None] * boxes.slopes[leaf]).sum(axis=2) + boxes.intercept[leaf]
        said = np.clip(said, boxes.low[leaf], boxes.high[leaf]).astype(float)
        std = said.std(axis=1) if boxes.std is None else boxes.std[leaf[:, 0]].astype(float)
        return said.mean(axis=1), std

    def probability(self, arguments: Array) -> Array:
        return self.predict(arguments)[0]

    def _parts(self, inside: Array):
        ends = [*self.boxes.first[1:], inside.shape[1]]
        return [(at, inside[:, at:end]) for at, end in zip(self.boxes.first, ends, strict=True)]


def _tree(rng: np.random.Generator, ranges: list[tuple[float, float]], depth: int) -> tuple[Array, Array]:
    """Lower and upper corners of the leaves of a tree that is split at random `depth` times on each way."""
    lower = np.full((1, len(ranges)), -np.inf)
    upper = np.full((1, len(ranges)), np.inf)
    for _ in range(depth):
        column = int(rng.integers(len(ranges)))
        at = np.clip(rng.uniform(*ranges[column], len(lower)), lower[:, column], upper[:, column])
        left, right = upper.copy(), lower.copy()
        left[:, column], right[:, column] = at, at
        lower, upper = np.vstack([lower, right]), np.vstack([left, upper])
    return lower, upper
