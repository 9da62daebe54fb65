"""skl2onnx converts our estimators, alone and in a pipeline."""

import numpy as np
import onnxruntime
import pytest
from skl2onnx import to_onnx
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from tailor.models.export import onnx_converters
from tailor.models.failure.distilled_forest import DistilledForest
from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_tree import FailureTree
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor

RNG = np.random.default_rng(0)
X = RNG.uniform(-1, 1, (800, 3)).astype(np.float32)
Y = np.where(X[:, 0] > 0.2, 2 * X[:, 1], 1 - X[:, 2])


@pytest.fixture(autouse=True)
def _registered() -> None:
    onnx_converters.register()


def run(model, **options):
    converted = to_onnx(model, X[:1], target_opset={"": 18, "ai.onnx.ml": 3}, **options)
    session = onnxruntime.InferenceSession(converted.SerializeToString(), providers=["CPUExecutionProvider"])
    return session.run(None, {session.get_inputs()[0].name: X})


@pytest.mark.parametrize("model", [ModelTreeRegressor(), ModelTreeRegressor("m5"), BaggedModelTrees(trees=3)])
def test_regressors_convert(model) -> None:
    model.fit(X, Y)
    assert np.abs(run(model)[0][:, 0] - model.predict(X)).max() <= 1e-4


def test_a_pipeline_with_a_model_tree_converts() -> None:
    model = make_pipeline(StandardScaler(), BaggedModelTrees(trees=3)).fit(X, Y)
    off = np.abs(run(model)[0][:, 0] - model.predict(X))
    assert np.quantile(off, 0.99) <= 1e-4  # scaling in single precision may move a row over a threshold


@pytest.mark.parametrize("model", [FailureTree(cost_ratio=5), FailureForest(trees=7, cost_ratio=2), DistilledForest()])
def test_failure_models_convert(model) -> None:
    model.fit(X, (X[:, 0] + RNG.normal(0, 0.3, len(X)) > 0).astype(int))
    label, probability = run(model, options={"zipmap": False})
    assert np.abs(probability - model.predict_proba(X)).max() <= 1e-5
    assert (label == model.predict(X)).mean() > 0.99  # a tie may fall either way
