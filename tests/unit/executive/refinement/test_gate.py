"""The refinement gate is applied where it is valid, reported, and evaluated by its effect."""

import dataclasses

import numpy as np
import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.gate import SITUATION, situation
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas.messages import RefinementReport
from tailor.tools.evaluations.gate_pairs import pairs_of
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.evaluations.refinement import gate as judging
from tailor.tools.evaluations.refinement import gate_ceiling
from tailor.tools.viewer.explanation_text import gate_text
from tests.support.synthetic_models import MODELS, approach_dribble

KIND = ("approachBall", "dribbleBall")


@dataclasses.dataclass(frozen=True)
class ConstantGate:
    """Predicts the same for every situation, and records them."""

    probability: float
    sequences: frozenset[tuple[str, ...]] = frozenset({KIND})
    input_names: tuple[str, ...] = SITUATION
    threshold: float = 0.5
    recorded: list[tuple[float, ...]] = dataclasses.field(default_factory=list)

    def p_slowdown(self, situations):
        self.recorded.extend(map(tuple, situations.tolist()))
        return np.full(len(situations), self.probability)


def searched(gate, slices: int = 1, horizon: int = 2) -> Refinement:
    models = dataclasses.replace(MODELS, gate=gate)
    settings = RefinementSettings(horizon=horizon, arrival_spread=())
    search = Refinement(approach_dribble((3.0, 0.0, 0.0)), models, settings, np.random.default_rng(3))
    while not search.finished:
        search.advance(CheckBudget(10_000 // slices))
    return search


def test_predicted_slowdown_keeps_the_greedy_choice_searched_as_with_horizon_one() -> None:
    free, kept = searched(None), searched(ConstantGate(0.9))
    assert free.choice.total_s < kept.choice.total_s  # the refined choice is better by the models
    alone = searched(None, horizon=1).choice
    assert kept.choice.predicted_s[0] == pytest.approx(alone.predicted_s[0], abs=0.02)
    verdict = kept.report().verdict
    assert (verdict.p_slowdown, verdict.keep_greedy) == (0.9, True)


def test_gate_below_its_threshold_changes_nothing() -> None:
    free, refined = searched(None), searched(ConstantGate(0.5))
    assert refined.choice == free.choice
    assert refined.report().verdict.p_slowdown == 0.5
    assert not refined.report().verdict.keep_greedy


def test_gate_is_not_queried_for_sequences_that_it_was_not_trained_for() -> None:
    other = ConstantGate(1.0, sequences=frozenset({("goToPose", "goToPose")}))
    assert searched(other).choice == searched(None).choice
    assert other.recorded == []


def test_prediction_that_is_not_a_number_is_ignored() -> None:
    search = searched(ConstantGate(float("nan")))
    assert search.choice == searched(None).choice
    assert search.report().verdict.p_slowdown == -1


def test_gate_is_not_queried_with_horizon_one() -> None:
    gate = ConstantGate(1.0)
    assert searched(gate, horizon=1).report().verdict.situation == ()
    assert gate.recorded == []


def test_decision_is_the_same_in_slices() -> None:
    assert searched(ConstantGate(0.9), slices=2000).choice == searched(ConstantGate(0.9)).choice


def test_situation_contains_gain_price_and_return_in_seconds() -> None:
    search = searched(ConstantGate(0.0))
    values = dict(zip(SITUATION, search.report().verdict.situation, strict=True))
    greedy, refined = searched(None, horizon=1).choice, search.choice
    assert values["gain_s"] == pytest.approx(search.report().greedy_s - refined.total_s)
    assert values["first_s"] + values["price_s"] == pytest.approx(refined.predicted_s[0])
    assert values["rest_s"] - values["return_s"] == pytest.approx(refined.predicted_s[1])
    assert values["first_s"] == pytest.approx(greedy.predicted_s[0], abs=0.1)
    assert 0 < values["turned_rad"] <= np.pi


def test_angles_are_compared_in_the_shorter_direction() -> None:
    sequence = approach_dribble()
    heading = next(v.id for v in sequence.free() if v.periodic)
    speed = next(v.id for v in sequence.free() if not v.periodic)
    one = searched(None).choice
    greedy = dataclasses.replace(one, values={heading: 3.1, speed: 0.3})
    refined = dataclasses.replace(one, values={heading: -3.1, speed: 0.0})
    values = dict(zip(SITUATION, situation(sequence, greedy, refined), strict=True))
    assert values["turned_rad"] == pytest.approx(2 * np.pi - 6.2)
    assert values["moved"] == 1.0


def test_explanation_contains_the_decision_of_the_gate() -> None:
    report = RefinementReport(
        0, 1, 2, "DifferentialEvolution", True, 10, 2, 9.0, 8.9, p_slowdown=0.62, kept_greedy=True
    )
    assert gate_text(report) == "greedy kept: the refinement gate predicts a slowdown with probability 62 %"
    assert gate_text(dataclasses.replace(report, p_slowdown=0.1, kept_greedy=False)).startswith("refined: ")
    assert gate_text(dataclasses.replace(report, p_slowdown=-1.0)) == ""


DONE = Outcome(1, "h2", True, 10.0, "achieved", (), (), (), (), False, 0.0, (), ())


def test_only_pairs_that_both_arrived_and_had_a_choice_are_training_data() -> None:
    seen = dataclasses.replace(DONE, situation=(1.0, 2.0), duration_s=9.0)
    lost = dataclasses.replace(DONE, achieved=False)
    pairs = pairs_of([(DONE, seen), (lost, seen), (DONE, DONE)])
    assert (pairs.situations.tolist(), pairs.greedy_s.tolist(), pairs.refined_s.tolist()) == ([[1, 2]], [10], [9])


def test_gate_is_evaluated_by_its_effect() -> None:
    fast, slow = dataclasses.replace(DONE, duration_s=8.0), dataclasses.replace(DONE, duration_s=12.0)
    gated = dataclasses.replace(slow, situation=tuple([0.0] * len(SITUATION)))
    starts = [(DONE, fast, fast), (DONE, gated, DONE), (DONE, fast, fast), (DONE, slow, slow)]
    row = judging.summary(starts, ConstantGate(0.9))
    assert row["right_pct"] == 75.0
    assert row["always_refining_right_pct"] == 50.0
    assert row["kept_pct"] == 25.0
    assert row["improvement_pct"] == pytest.approx(0.0)
    assert row["gated_pct"] == pytest.approx(5.0)
    assert row["perfect_pct"] == pytest.approx(10.0)
    assert (row["slower_pct"], row["gated_slower_pct"]) == (50.0, 25.0)
    assert row["lost_s"] == 1.0


def test_foreknowledge_comes_from_the_other_runs_and_never_from_the_evaluated_one() -> None:
    greedy_s = np.full((2, 5), 10.0)
    refined_s = np.array([[11.0, 11, 11, 11, 9], [9.0, 9, 9, 11, 9]])
    row = gate_ceiling.judged(greedy_s, refined_s)
    assert row["ceiling_right_pct"] == 80.0  # the one run of each start that went otherwise is not foreseen
    assert row["repeated_always_right_pct"] == 50.0
    assert row["ceiling_improvement_pct"] == pytest.approx((4 * 10 - 10) / 10)
    assert row["mostly_slower_starts_pct"] == 50.0
