"""An action that takes less or more than its model's interval is reported."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.executive.core.execution import Running, first_action
from tailor.executive.interfaces.models import Models
from tests.support.synthetic_models import GO

START_NS = 5_000_000_000


@dataclass
class Calibrated:
    calibrated: bool = True
    above_s: float = 2.0

    def interval(self, arguments):
        seconds = arguments[:, 4] - arguments[:, 0]
        return seconds, seconds - 1.0, seconds + self.above_s


def started(model, context=(), **others) -> Running:
    first = SimpleNamespace(action=GO, step=1, asserted=False, variables=tuple(range(8)), context=context)
    variables = tuple(SimpleNamespace(value=value) for value in (0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0))
    sequence = SimpleNamespace(actions=(first,), variables=variables)
    decision = SimpleNamespace(sequence=sequence, choice=SimpleNamespace(values={}, predicted_s=(3.0,)))
    return first_action(decision, Models({"goToPose/duration": model} | others, {}), START_NS)


@pytest.mark.parametrize(("elapsed_s", "surprising"), [(1.9, True), (2.0, False), (5.0, False), (5.1, True)])
def test_an_action_beyond_its_interval_is_reported(elapsed_s, surprising) -> None:
    text = started(Calibrated()).surprise(START_NS + round(elapsed_s * 1e9))
    assert bool(text) is surprising
    assert not surprising or "2.0..5.0 s" in text


def test_beside_objects_the_interval_is_that_of_the_model_calibrated_there() -> None:
    others, object_row = {"goToPose/duration_beside": Calibrated(above_s=4.0)}, ((1.0, 0.5, 0.2),)
    assert started(Calibrated(), object_row, **others).interval_s == (2.0, 7.0)
    assert started(Calibrated(), (), **others).interval_s == (2.0, 5.0)
    assert started(Calibrated(), object_row).interval_s == (2.0, 5.0)


def test_a_model_without_intervals_reports_nothing() -> None:
    assert started(Calibrated(calibrated=False)).interval_s is None
    assert started(object()).surprise(START_NS + 10**12) == ""


def test_predictions_of_a_redirected_action_count_from_its_start() -> None:
    running = started(Calibrated())
    later = running.redirected(started(Calibrated()), START_NS + 1_000_000_000)
    assert (later.predicted_s, later.interval_s) == (4.0, (3.0, 6.0))
    assert later.started_ns == START_NS
    assert np.isfinite(later.time_limit_s())
    assert running.redirected(started(Calibrated()), START_NS - 100_000_000).predicted_s == running.predicted_s
