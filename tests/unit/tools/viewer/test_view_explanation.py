"""An explanation computed from a message agrees with the refinement that published the message."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.refinement import Refinement
from tailor.models.features.features import Quantity
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import RefinementReport, Subgoals
from tailor.tools.figures.alternatives import draw_alternatives
from tailor.tools.viewer.decisions.decision_reader import Decision
from tailor.tools.viewer.decisions.explanation_text import (
    duration_table,
    explanation_lines,
    features_text,
    long_search_text,
    search_text,
)
from tailor.tools.viewer.decisions.recorded_search import RecordedSearch
from tailor.tools.viewer.explainer import Explainer, fields_of
from tailor.tools.viewer.explanations import missing_certificate
from tailor.tools.viewer.explanations.decided_sequence import decided, sequence_of
from tailor.tools.viewer.explanations.explanation import explain
from tailor.tools.viewer.explanations.longer_search import best_cost
from tailor.tools.viewer.explanations.situation import Situation
from tests.support import synthetic_run
from tests.support.synthetic_models import LIBRARY, MODELS, PoseDuration, approach_dribble

SETTINGS = synthetic_run.SETTINGS


@pytest.fixture(scope="module")
def refined():
    sequence = approach_dribble(robot=(-1.2, -0.6, 2.4))
    return sequence, chosen(sequence, SETTINGS)


def chosen(sequence, settings):
    search = Refinement(sequence, MODELS, settings, np.random.default_rng(3))
    search.advance(CheckBudget(60))
    return search.choice


def message_of(sequence, choice) -> Subgoals:
    return synthetic_run.subgoals(2, sequence, choice, 0)


def explained(message: Subgoals, models=MODELS, settings=SETTINGS):
    decision = decided(message, LIBRARY, models, settings)
    return None if decision is None else explain(decision, np.random.default_rng(0))


def least_cost(message: Subgoals, settings=SETTINGS, checks=100):
    return best_cost(decided(message, LIBRARY, MODELS, settings), np.random.default_rng(1), checks)


def test_the_sequence_is_rebuilt_from_its_message(refined) -> None:
    rebuilt = sequence_of(message_of(*refined), LIBRARY)
    for old, new in zip(refined[0].variables, rebuilt.variables, strict=True):
        assert (new.lower, new.upper, new.periodic, new.value) == (old.lower, old.upper, old.periodic, old.value)
    assert [a.variables for a in rebuilt.actions] == [a.variables for a in refined[0].actions]


def test_the_explained_choice_is_the_choice(refined) -> None:
    explanation = explained(message_of(*refined))
    assert explanation.chosen_s == pytest.approx(refined[1].predicted_s)
    assert explanation.chosen_cost == pytest.approx(refined[1].total_s)
    assert explanation.greedy_cost >= explanation.chosen_cost


def report(finished=True):
    return RefinementReport(0, 2, 2, "Chain", finished, 9, 9, 5.0, 4.0)


UNSPANNED = {name: replace(each, arguments=lambda values: 1.0 * values, spans=None) for name, each in LIBRARY.items()}
REASONS = {
    "certify_checks is 0": {"settings": replace(SETTINGS, certify_checks=0)},
    "approachBall: its models have no bounds": {},
    "approachBall: its model arguments are not available as intervals": {"library": UNSPANNED},
}
UNPROVEN = {
    "the search was interrupted before a proof began": report(finished=False),
    "no gap of at most 25 % was proven in the time that the search had left": report(),
}


def reason_for(refined, search=None, library=LIBRARY, settings=SETTINGS):
    decision = decided(message_of(*refined), library, MODELS, settings)
    return missing_certificate.why_not_certified(decision, search or report())


@pytest.mark.parametrize("reason", REASONS)
def test_a_choice_that_has_no_bound_has_a_reason(refined, reason) -> None:
    assert reason_for(refined, **REASONS[reason]) == reason


@pytest.mark.parametrize("reason", UNPROVEN)
def test_a_proof_that_proved_nothing_is_a_reason(refined, reason, monkeypatch) -> None:
    monkeypatch.setattr(missing_certificate, "certificate", lambda *given: object())
    assert reason_for(refined, UNPROVEN[reason]) == reason


def test_the_reason_is_printed_in_place_of_the_gap(refined) -> None:
    explanation = explained(message_of(*refined))
    lines = explanation_lines(
        explanation, 4.0, Decision(1.0, message_of(*refined), RecordedSearch(report(), 3, 0.1)), "its models are odd"
    )
    assert "not certified: its models are odd" in lines


def test_greedy_makes_the_first_action_shorter_and_the_whole_longer(refined) -> None:
    explanation = explained(message_of(*refined))
    assert explanation.greedy_s[0] < explanation.chosen_s[0]
    assert sum(explanation.greedy_s) > sum(explanation.chosen_s)


def test_greedy_is_what_a_run_with_a_horizon_of_one_chooses_not_its_first_answer() -> None:
    sequence = approach_dribble(robot=(2.0, 0.0, -2.0))
    both, lone = (chosen(sequence, replace(SETTINGS, horizon=horizon)) for horizon in (2, 1))
    explanation = explained(message_of(sequence, both))
    assert explanation.greedy_s[0] == pytest.approx(lone.predicted_s[0], rel=0.01)


def test_alternatives_cover_the_range_and_name_the_actions_that_they_touch(refined) -> None:
    angle = next(p for p in explained(message_of(*refined)).parameters if p.variable.quantity == "phi")
    assert angle.touched == (0, 1)
    assert angle.alternatives.values[[0, -1]] == pytest.approx([-np.pi, np.pi])
    assert np.nanmin(angle.alternatives.total_s) >= 0.98 * refined[1].total_s, "the choice is (almost) the best of them"


def test_nothing_free_and_unknown_actions_have_no_explanation(refined) -> None:
    message = message_of(*refined)
    bound = tuple(replace(a, parameters=tuple(replace(p, bound=True) for p in a.parameters)) for a in message.actions)
    assert explained(replace(message, actions=bound)) is None
    assert explained(replace(message, actions=())) is None
    assert decided(message, {}, MODELS, SETTINGS) is None


def test_a_risk_that_was_accepted_is_explained_and_not_invalid(refined) -> None:
    strict = replace(SETTINGS, p_fail_max=0.0)
    explanation = explained(message_of(*refined), settings=strict)
    assert np.isfinite(explanation.chosen_cost)


def test_where_energy_is_weighed_its_part_of_the_cost_is_message_of(refined) -> None:
    energies = {"goToPose/energy": PoseDuration(), "dribbleBall/energy": PoseDuration()}
    models, weighed = replace(MODELS, durations=MODELS.durations | energies), replace(SETTINGS, energy_weight=0.5)
    explanation = explained(message_of(*refined), models, weighed)
    assert len(explanation.chosen_j) == len(explanation.chosen_s)
    plain = explained(message_of(*refined))
    assert explanation.chosen_cost == pytest.approx(plain.chosen_cost + 0.5 * sum(explanation.chosen_j))
    assert fields_of(explanation)["energy"][0] == pytest.approx(list(explanation.chosen_j), abs=1e-3)
    assert "energy" in [str(cell) for cell in duration_table(explanation).columns[0].cells]
    assert plain.chosen_j == ()
    assert "energy" not in fields_of(plain)


def test_fields_are_json_even_where_everything_is_invalid(refined) -> None:
    explanation = explained(message_of(*refined))
    assert json.dumps(fields_of(replace(explanation, greedy_cost=float("inf"))), allow_nan=False)


def test_a_decision_with_a_parameter_that_is_no_number_is_explained_and_drawn(refined, tmp_path) -> None:
    first, *others = message_of(*refined).actions
    place, *kept = first.parameters
    damaged = replace(first, parameters=(replace(place, value=float("nan")), *kept))
    explanation = explained(replace(message_of(*refined), actions=(damaged, *others)))
    assert explanation.chosen_cost == float("inf")
    draw_alternatives([("a decision", explanation)], tmp_path / "why.png")
    assert (tmp_path / "why.png").exists()


def test_a_picture_states_the_seconds_of_the_table(refined, tmp_path, monkeypatch) -> None:
    """Between the values that a curve has they were 0.05 s longer: a bowl lies below its chords."""
    figures = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: figures.append(figure))
    explanation = explained(message_of(*refined))
    seconds = tuple(10.0 * (1 + place) for place in range(len(explanation.actions)))
    draw_alternatives([("a decision", replace(explanation, chosen_s=seconds))], tmp_path / "why.png")
    labels = [axis.get_xlabel().partition("chosen: ")[2] for axis in figures[0].axes]
    parameters = explanation.parameters
    shown = [(*(seconds[i] for i in parameter.touched), sum(seconds)) for parameter in parameters]
    assert labels == [f"{each:.1f} s" for row in shown for each in row]


def test_a_run_whose_models_are_missing_is_shown_without_explanations(refined) -> None:
    def missing(recorded):
        raise UsageError("no model agilo/goToPose/duration")

    explainer = Explainer(missing)
    explainer.load("{}")
    assert explainer.fields(message_of(*refined)) is None
    assert explainer.missing == "no model agilo/goToPose/duration"


def test_a_long_search_is_never_worse_than_the_choice_and_finds_what_a_poor_choice_missed(refined) -> None:
    sequence, choice = refined
    least = least_cost(message_of(sequence, choice))
    assert least <= choice.total_s + 1e-9
    angle = next(v.id for v in sequence.free() if v.quantity == "phi")
    poor = replace(choice, values={**choice.values, angle: choice.values[angle] - 0.3})
    cost = explained(message_of(sequence, poor)).chosen_cost
    assert cost > least + 0.01
    assert least_cost(message_of(sequence, poor)) == pytest.approx(least, abs=0.02)


def test_a_long_search_looks_beyond_greedy_whatever_gain_the_executive_requires(refined) -> None:
    sequence, choice = refined
    for required in ({"gain_k_std": 0.5}, {"gain_k_std": 0.0, "gain_min_s": 100.0}):
        settings = replace(SETTINGS, **required)
        assert least_cost(message_of(sequence, choice), settings) <= choice.total_s + 1e-9


def test_the_situation_holds_the_features_of_the_duration_model(refined) -> None:
    @dataclass
    class Carded(PoseDuration):
        card = {"features": "projective"}

    models = replace(MODELS, durations={**MODELS.durations, "goToPose/duration": Carded()})
    explanation = explained(message_of(*refined), models)
    (situation,) = explanation.situations
    assert (situation.action, [q.name for q in situation.features]) == (
        "approachBall",
        ["v", "v_g", "dist", "angle_to", "angle_at"],
    )
    speed = next(p for p in explanation.parameters if p.variable.quantity == "v")
    assert (situation.chosen[1], situation.greedy[1]) == pytest.approx((speed.chosen, speed.greedy))
    assert situation.chosen[2] == pytest.approx(np.hypot(2.2, 0.6), rel=1e-5)


@pytest.mark.parametrize(
    ("chosen", "best", "words"),
    [(10.0, 10.0, "finds no better choice"), (11.0, 10.0, "1.00 s (10.0 %) better"), (9.0, np.inf, "no valid choice")],
)
def test_the_gap_to_a_long_search_is_given_in_seconds_and_per_cent(chosen, best, words) -> None:
    assert words in long_search_text(chosen, best)


@pytest.mark.parametrize(("chosen_s", "late"), [(8.58, False), (8.78, True), (float("inf"), False)])
def test_a_better_choice_that_was_not_adopted_is_named(chosen_s, late) -> None:
    report = RefinementReport(0, 9, 2, "DifferentialEvolution", True, 12096, 109, 8.77, 8.58)
    text = search_text(Decision(8.9, Subgoals(0, 7, 2), RecordedSearch(report, 3, 0.18)), chosen_s)
    assert ("found after the action had begun and not adopted" in text) == late


@pytest.mark.parametrize(
    ("greedy", "best", "words"),
    [(-1.0, 8.6, "objective INVALID (greedy) to 8.60 s"), (-1.0, -1.0, "objective INVALID (greedy) to INVALID")],
)
def test_an_invalid_objective_is_no_number_of_seconds(greedy, best, words):
    """As a message has no infinity, it holds -1 s."""
    report = RefinementReport(0, 9, 2, "DifferentialEvolution", True, 12096, 109, greedy, best)
    text = search_text(Decision(8.9, Subgoals(0, 7, 2), RecordedSearch(report, 3, 0.18)), 8.6)
    assert text.endswith(words)


def test_what_rounds_to_zero_has_no_sign():
    quantities = (Quantity("angle_to", "rad"), Quantity("v", "m/s"))
    text = features_text(Situation("goToPose", quantities, (-0.001, -0.001), (0.0, -0.5)))
    assert text == "goToPose features (greedy): angle_to 0° (0°), v 0.00 m/s (-0.50 m/s)"


def test_a_quantity_without_unit_is_a_plain_number():
    quantities = (Quantity("out", "1"), Quantity("dist", "m"))
    text = features_text(Situation("grip", quantities, (0.5, 2.0), (1.0, 2.0)))
    assert text == "grip features (greedy): out 0.50 (1.00), dist 2.00 m (2.00 m)"


@pytest.mark.parametrize("damage", ["a parameter too few", "an id that no message holds", "a negative id"])
def test_a_damaged_message_has_no_explanation(refined, damage) -> None:
    message = message_of(*refined)
    first, *others = message.actions
    parameters = first.parameters[:-1]
    if damage != "a parameter too few":
        wrong = 2**31 - 2 if damage == "an id that no message holds" else -5
        parameters = (*parameters, replace(first.parameters[-1], id=wrong))
    damaged = replace(message, actions=(replace(first, parameters=parameters), *others))
    assert sequence_of(damaged, LIBRARY) is None
    assert explained(damaged) is None


def test_a_message_without_a_horizon_has_no_explanation(refined) -> None:
    assert explained(replace(message_of(*refined), horizon=0)) is None


def test_a_horizon_beyond_the_last_action_is_explained_as_one_of_all_actions(refined) -> None:
    message = replace(message_of(*refined), horizon=10**6)
    assert explained(message).chosen_cost == explained(message_of(*refined)).chosen_cost
    assert least_cost(message, checks=5) < float("inf")


def test_models_that_do_not_suit_the_settings_of_a_run_end_no_page(refined, monkeypatch) -> None:
    def explaining(_: Subgoals) -> None:
        raise UsageError("action drive needs the model drive/energy")

    explainer = Explainer()
    monkeypatch.setattr(explainer, "explanation", explaining)
    assert explainer.fields(message_of(*refined)) is None
    assert explainer.missing == "action drive needs the model drive/energy"
