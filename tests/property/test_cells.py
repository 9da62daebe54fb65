"""Tables of cells find the leaf that a walk down the tree finds, on thresholds too; and they can be read back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.models.bounds.cell_boxes import boxes_of_cells
from tailor.models.bounds.onnx_reader import read_graph
from tailor.models.export.onnx_export import export_duration
from tailor.models.features.planar import projective
from tailor.models.fitted_trees.cells import MAX_CELLS, cells_of
from tailor.models.fitted_trees.split_tree import LEAF, SplitTree
from tailor.models.trees.model_tree import BaggedModelTrees
from tests.support import standin

FEATURES = 3


def random_tree(rng: np.random.Generator, leaves: int) -> SplitTree:
    """Splits of random leaves at one of few thresholds, so that features and trees share them."""
    nodes = [(LEAF, 0.0, 0, 0, 0)]
    for _ in range(leaves - 1):
        at = rng.choice([k for k, node in enumerate(nodes) if node[0] == LEAF])
        threshold = float(rng.integers(-3, 4)) / 2
        nodes[at] = (int(rng.integers(FEATURES)), threshold, len(nodes), len(nodes) + 1, -1)
        nodes += [(LEAF, 0.0, 0, 0, 0)] * 2
    ends = iter(range(leaves))
    return SplitTree.of([node if node[0] != LEAF else (*node[:4], next(ends)) for node in nodes])


def rows(rng: np.random.Generator) -> np.ndarray:
    """Some of them on thresholds, or one float beside."""
    coarse = (rng.integers(-4, 5, (300, FEATURES)) / 2).astype(np.float32)
    side = np.where(rng.random(coarse.shape) < 0.5, np.float32(9), np.float32(-9))
    return np.concatenate([coarse, np.nextafter(coarse, side), rng.normal(0, 1.5, (300, FEATURES)).astype(np.float32)])


@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.integers(2, 12))
@settings(max_examples=50, deadline=None)
def test_a_cell_lies_in_the_leaf_that_its_rows_fall_into(seed: int, count: int, leaves: int) -> None:
    rng = np.random.default_rng(seed)
    trees = [random_tree(rng, leaves) for _ in range(count)]
    cells = cells_of(trees, FEATURES)
    assert cells is not None
    x = rows(rng)
    beyond = (x[:, cells.feature] > cells.threshold).astype(np.float32)
    found = cells.leaf[(beyond @ cells.strides + cells.first).astype(np.int64)]
    assert np.array_equal(found, np.stack([tree.leaf_of(x) for tree in trees], axis=1))


def test_too_many_cells_and_trees_without_splits_have_no_table() -> None:
    rng = np.random.default_rng(0)
    assert cells_of([random_tree(rng, 1)], FEATURES) is None
    fine = np.array([(k % FEATURES, k / 7.0) for k in range(3 * 120)])  # 121 ** 3 cells
    nodes = [(int(f), t, k + 1, len(fine) + 1 + k, -1) for k, (f, t) in enumerate(fine)]
    nodes += [(LEAF, 0.0, 0, 0, k) for k in range(len(fine) + 1)]
    assert MAX_CELLS < 121**3
    assert cells_of([SplitTree.of(nodes)], FEATURES) is None


@pytest.fixture(scope="module")
def bag() -> BaggedModelTrees:
    arguments, targets, groups = standin.examples(standin.episodes(150, seed=4), 10)
    return BaggedModelTrees(trees=3).fit(projective(arguments), targets, groups=groups)


def test_the_boxes_read_back_hold_the_rows_of_their_leaves(bag: BaggedModelTrees) -> None:
    graph = read_graph(export_duration(bag, projective, {}).SerializeToString())
    assert "TreeEnsembleRegressor" not in {node.op for node in graph.nodes}  # this bag is small enough for cells
    first, lower, upper, said = boxes_of_cells(graph, 5)
    x = np.random.default_rng(1).uniform([0, 0, 0, 0, -3], [0.6, 0.6, 6, 3, 3], (500, 5)).astype(np.float32)
    inside = ((x[:, None] > lower) & (x[:, None] <= upper)).all(axis=2)  # (n, leaves)
    for k, tree in enumerate(bag.trees_):
        mine = inside[:, first[k] : first[k] + tree.leaves]
        assert (mine.sum(axis=1) == 1).all()
        assert np.array_equal(said[first[k] + mine.argmax(axis=1)], tree.splits.leaf_of(x))
