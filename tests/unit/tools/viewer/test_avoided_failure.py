"""An asserted subgoal is explained by the failure that it avoids."""

import json
import math
import re
from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas.messages import Subgoals
from tailor.tools.viewer.decisions.explained_decisions import explained_decisions
from tailor.tools.viewer.decisions.explanation_text import explanation_lines
from tailor.tools.viewer.explainer import fields_of
from tailor.tools.viewer.explanations.decided_sequence import decided
from tailor.tools.viewer.explanations.explanation import Explanation, explain
from tests.support import synthetic_run
from tests.support.bus_system import ROOT
from tests.support.synthetic_models import LIBRARY, MODELS, approach_dribble


def explained(message: Subgoals) -> Explanation | None:
    decision = decided(message, LIBRARY, MODELS, synthetic_run.SETTINGS)
    return None if decision is None else explain(decision, np.random.default_rng(0))


def a_message() -> Subgoals:
    sequence = approach_dribble(robot=(-1.2, -0.6, 2.4))
    search = Refinement(sequence, MODELS, synthetic_run.SETTINGS, np.random.default_rng(3))
    search.advance(CheckBudget(10))
    return synthetic_run.subgoals(2, sequence, search.choice, 0)


def test_the_action_after_the_subgoal_would_fail_on_a_straight_way_and_the_lines_say_so() -> None:
    first, *others = explained_decisions(ROOT / "tests" / "data" / "golden" / "soccer-opponents.mcap")
    assert first.explanation is not None
    avoided = first.explanation.avoided
    assert (avoided.action, avoided.straight > 0.9, avoided.by_subgoal < 0.02) == ("goToPose", True, True)
    assert [each.explanation and each.explanation.avoided for each in others] == [None]
    line, *_ = explanation_lines(first.explanation, 4.0, first.decision, "")
    assert re.fullmatch(r"subgoal asserted: .* goToPose .* fail with 9\d %, by way of the subgoal with 1 %", line)
    assert fields_of(first.explanation)["avoided"]["action"] == "goToPose"


def test_nothing_is_avoided_without_a_subgoal_or_without_an_action_after_it() -> None:
    message = a_message()
    assert explained(message).avoided is None
    alone = tuple(replace(each, asserted=True) for each in message.actions)
    assert explained(replace(message, actions=alone)).avoided is None


def test_a_damaged_message_of_a_subgoal_is_explained_without_an_error() -> None:
    message = a_message()
    first, *others = message.actions
    wrong = tuple(replace(each, value=math.nan) for each in first.parameters)
    damaged = replace(message, actions=(replace(first, asserted=True, parameters=wrong), *others))
    json.dumps(fields_of(explained(damaged)), allow_nan=False)
