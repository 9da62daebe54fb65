"""The exported graph computes what the learner computes: 1e-4 s over 1e5 inputs, degenerate and on thresholds too."""

import numpy as np
import onnxruntime
import pytest

from tailor.models.bounds.tree_boxes import tree_boxes
from tailor.models.export.onnx_export import export_duration, export_success
from tailor.models.failure.distilled_forest import DistilledForest
from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_tree import FailureTree
from tailor.models.features.joints import joints
from tailor.models.features.planar import projective
from tailor.models.features.spaces import feature_spaces
from tailor.models.fitted_trees import cells
from tailor.models.fitted_trees.split_tree import LEAF
from tailor.models.regression import network_training
from tailor.models.regression.blend import BlendedRegressor
from tailor.models.regression.calibrated import CalibratedRegressor
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor
from tests.support import standin

PI = np.pi
TOLERANCE = 1e-4


def session(model):
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.log_severity_level = 1
    return onnxruntime.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])


def awkward(count: int = 100_000):
    """Random poses, a fifth degenerate: same place, same heading, on an axis, straight ahead, straight behind."""
    rng = np.random.default_rng(5)
    rows = rng.uniform([-3.5, -2.25, -PI, 0] * 2, [3.5, 2.25, PI, 0.6] * 2, (count, 8))
    part = count // 25
    rows[:part, 4:6] = rows[:part, :2]
    rows[part : 2 * part, 6] = rows[part : 2 * part, 2]
    rows[2 * part : 3 * part, 5] = rows[2 * part : 3 * part, 1]
    rows[2 * part : 2 * part + 400, 2] = np.repeat([0, PI, -PI, PI / 2], 100)
    sight = np.arctan2(*(rows[3 * part : 5 * part, [5, 4]] - rows[3 * part : 5 * part, [1, 0]]).T)
    rows[3 * part : 4 * part, 2] = sight[:part]
    rows[4 * part : 5 * part, 2] = sight[part:] + PI
    return rows


@pytest.fixture(scope="module")
def episodes():
    return standin.episodes(150, seed=4)


@pytest.fixture(scope="module")
def examples(episodes):
    return standin.examples(episodes, 10)


def on_thresholds(splits, base):
    """Rows whose v, v_g or dist sits exactly on each threshold, one float below and one above."""
    made = []
    for feature, threshold in zip(splits.feature, splits.threshold, strict=True):
        if feature in (LEAF, 3, 4):
            continue
        for value in (threshold, np.nextafter(threshold, np.float32(-9)), np.nextafter(threshold, np.float32(9))):
            rows = base[:20].copy()
            if feature == 2:
                rows[:, [0, 1, 5]] = 0.0
                rows[:, 4] = value
            else:
                rows[:, (3, 7)[feature]] = value
            made.append(rows)
    return np.concatenate(made) if made else base[:0]


@pytest.mark.parametrize("learner", [ModelTreeRegressor(), ModelTreeRegressor("m5"), BaggedModelTrees(trees=4)])
def test_durations_agree(learner, examples) -> None:
    arguments, targets, groups = examples
    learner.fit(projective(arguments), targets, groups=groups)
    rows = np.concatenate([awkward(), *(on_thresholds(tree.splits, awkward(1000)) for tree in learner.trees_)])
    mean, std = session(export_duration(learner, projective, {})).run(None, {"arguments": rows})
    expected = learner.predict_with_std(projective(rows))
    assert np.abs(mean - expected[0]).max() <= TOLERANCE
    assert np.abs(std - expected[1]).max() <= TOLERANCE


BLENDS = {
    "network": BlendedRegressor(weights={"network": 1.0}),
    "deep-network": BlendedRegressor(weights={"deep-network": 1.0}),
    "stack": BlendedRegressor(weights={"bag": 0.4, "network": 0.6}),
    "bag": BlendedRegressor(weights={"bag": 1.0}),
}


@pytest.mark.parametrize("name", BLENDS)
def test_intervals_agree(name, examples, monkeypatch) -> None:
    """But where the standard deviation lies on a threshold of the intervals, to rounding errors."""
    monkeypatch.setattr(network_training, "STEPS", 150)  # of 4000: what is exported need not predict well
    arguments, targets, groups = examples
    learner = CalibratedRegressor(BLENDS[name]).fit(projective(arguments), targets, groups=groups)
    rows = awkward()
    results = session(export_duration(learner, projective, {})).run(None, {"arguments": rows})
    expected = learner.predict_interval(projective(rows))
    std = learner.predict_with_std(projective(rows))[1]
    splits = learner.intervals_.splits
    thresholds = splits.threshold[splits.feature == 5]
    clear = np.abs(std[:, None] - thresholds).min(axis=1, initial=1.0) > 1e-4
    assert clear.mean() > 0.99
    assert np.abs(results[0] - expected[0]).max() <= TOLERANCE
    for result, values in zip(results[1:], expected[1:], strict=True):
        assert np.abs(result - values)[clear].max() <= TOLERANCE


def test_a_bag_of_too_many_cells_walks_down_its_trees(examples, monkeypatch) -> None:
    monkeypatch.setattr(cells, "MAX_CELLS", 10)
    arguments, targets, groups = examples
    bag = BaggedModelTrees(trees=3).fit(projective(arguments), targets, groups=groups)
    model = export_duration(bag, projective, {})
    assert [node.op_type for node in model.graph.node].count("TreeEnsembleRegressor") == 3
    rows = awkward(10_000)
    mean, std = session(model).run(None, {"arguments": rows})
    expected = bag.predict_with_std(projective(rows))
    assert np.abs(mean - expected[0]).max() <= TOLERANCE
    assert np.abs(std - expected[1]).max() <= TOLERANCE
    boxes = tree_boxes(model.SerializeToString(), 5)
    assert boxes is not None
    assert len(boxes.low) == sum(tree.leaves for tree in bag.trees_)


@pytest.mark.parametrize("learner", [FailureTree(cost_ratio=5), FailureForest(trees=20), DistilledForest()])
def test_probabilities_agree(learner, episodes) -> None:
    arguments, _, _ = standin.examples(episodes, 1)
    learner.fit(projective(arguments), np.array([success for _, _, success in episodes]))
    rows = np.concatenate([awkward(), *(on_thresholds(splits, awkward(1000)) for splits, _ in learner.steps_)])
    (success,) = session(export_success(learner, projective, {})).run(None, {"arguments": rows})
    assert np.abs(success - learner.predict_proba(projective(rows))[:, 1]).max() <= 1e-5


@pytest.mark.parametrize("name", feature_spaces())
def test_every_feature_space_gives_the_same_bits_in_the_graph(name, examples) -> None:
    """A tree with a leaf every few rows shows any difference of a single bit."""
    space = feature_spaces()[name]
    rows = awkward(8000)
    rest = np.random.default_rng(6).uniform(-2, 2, (len(rows), max(0, len(space.arguments) - 8)))
    rows = np.hstack([rows, rest])[:, : len(space.arguments)]
    features = space(rows)
    tree = ModelTreeRegressor(min_rows=20, held_out=0.0, ridge=1e-3).fit(features, np.sin(9 * features).sum(axis=1))
    mean, _ = session(export_duration(tree, space, {})).run(None, {"arguments": rows})
    assert np.abs(mean - tree.predict(features)).max() <= TOLERANCE


def test_joint_space_exports_too() -> None:
    assert session(export_duration(_fitted(joints), joints, {})).get_inputs()[0].shape[1] == 8


def _fitted(space):
    rows = np.hstack([awkward(500), np.ones((500, 2))])[:, : len(space.arguments)]
    return ModelTreeRegressor().fit(space(rows), rows.sum(axis=1))


def test_what_is_not_a_number_stays_not_a_number(examples) -> None:
    arguments, targets, groups = examples
    bag = BaggedModelTrees(trees=3).fit(projective(arguments), targets, groups=groups)
    rows = awkward(1000)[:20].copy()
    rows[np.arange(8), np.arange(8)] = np.nan
    rows[8 + np.arange(8), np.arange(8)] = np.inf
    for learner in (bag, ModelTreeRegressor().fit(projective(arguments), targets)):
        mean, _ = session(export_duration(learner, projective, {})).run(None, {"arguments": rows})
        assert np.isnan(mean[:16]).all()
        assert np.isfinite(mean[16:]).all()


def test_the_runtime_has_nothing_to_warn_about(examples, capfd) -> None:
    arguments, targets, groups = examples
    bag = BaggedModelTrees(trees=3).fit(projective(arguments), targets, groups=groups)
    running = session(export_duration(bag, projective, {}))
    for count in (1, 7, 250):
        running.run(None, {"arguments": awkward(1000)[:count]})
    assert "[W:" not in capfd.readouterr().err
