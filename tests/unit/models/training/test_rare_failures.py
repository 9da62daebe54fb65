"""Networks of success where failures are rare: scikit-learn's early stopping may end them before they have learned."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.metrics import log_loss

from tailor.models.training.learners import make_learner
from tailor.models.training.sklearn_adapters import SklearnClassifier

ROWS = 1200


def outcomes(lean: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Features, the probability of success that they determine, and outcomes drawn by it."""
    rng = np.random.default_rng(3)
    features = rng.normal(size=(ROWS, 4))
    probability = 1 / (1 + np.exp(features[:, 0] - lean))
    return features, probability, rng.uniform(size=ROWS) < probability


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["network", "networks"])
def test_networks_learn_failures_that_are_rare(name):
    features, probability, success = outcomes(lean=2.6)
    assert success.mean() > 0.88
    predicted = make_learner("success", name, 0).fit(features, success).predict_proba(features)[:, 1]
    assert predicted.mean() == pytest.approx(success.mean(), abs=0.01)
    assert np.abs(predicted - probability).mean() < 0.05
    assert log_loss(success, predicted) < log_loss(success, np.full(ROWS, success.mean()))


def test_networks_that_have_learned_are_those_that_stopped_early():
    features, _, success = outcomes(lean=0.5)
    model = make_learner("success", "networks", 0)
    alone = SklearnClassifier(model.inner).fit(features, success)
    assert (model.fit(features, success).predict_proba(features) == alone.predict_proba(features)).all()
