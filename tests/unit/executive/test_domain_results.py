"""A method of a domain that returns nothing, or anything else than declared, ends the run with one line.

So does a function of an action; `test_controller_results` is about controllers.
"""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.state import initial_state
from tailor.executive.interfaces.outlet import messages_of, staying
from tailor.executive.interfaces.values import Interval
from tailor.executive.refinement.objective.subgoal_risk import risk_to_next
from tailor.schemas.errors import UsageError
from tests.support.toy_domain import LineBelief, LineDomain, line_context
from tests.unit.executive.core.test_core import drive

WRONG = {
    "anchor": [
        (lambda own: None, "None, expected a frozenset of facts"),
        (list, r"\[.*, expected a frozenset of facts"),
        (lambda own: own | {"at home"}, r"the fact 'at home', expected facts such as \(\"robot\", \"pos1\"\)"),
        (lambda own: own | {("at", 3)}, r"the fact \('at', 3\), expected facts"),
        (lambda own: own | {()}, r"the fact \(\), expected facts"),
        (lambda own: own | {None}, "the fact None, expected facts"),
    ],
    "belief_values": [
        (lambda own: None, "None, expected a tuple of numbers"),
        (lambda own: own[0], "0.0, expected a tuple of numbers"),
        (lambda own: ("1",), r"\('1',\), expected a tuple of numbers"),
        (lambda own: (None,), r"\(None,\), expected a tuple of numbers"),
    ],
    "ready": [
        (lambda own: None, "None, expected True or False"),
        (lambda own: np.zeros(2), r"array\(\[0., 0.\]\), expected True or False"),
    ],
    "update": [(lambda own: None, "None, expected a belief")],
    "value": [
        (lambda own: 3.0, "3.0, expected an Interval of numbers or None"),
        (lambda own: (1.0, 2.0), r"\(1.0, 2.0\), expected an Interval of numbers or None"),
        (lambda own: Interval(None, None), r"Interval\(.*\), expected an Interval of numbers or None"),
        (lambda own: Interval(np.zeros(1), np.zeros(1)), r"Interval\(.*\), expected an Interval of numbers or None"),
    ],
    "relocations": [(lambda own: None, "None, expected a whole number"), (lambda own: "2", "'2', expected a whole")],
    "measurement_fault": [(lambda own: None, "None, expected text, empty for a measurement")],
    "kept": [
        (lambda own: None, "None, expected one set-point for each of 1 axes"),
        (lambda own: (0.0, 0.0), r"\(0.0, 0.0\), expected one set-point for each of 1 axes"),
    ],
}
OPTIONAL = {"relocations": 0, "measurement_fault": "", "kept": ()}
CASES = [(method, *case) for method, cases in WRONG.items() for case in cases]


def domain_with(method, result):
    """The line's domain with a method that returns what `result` makes of the proper value."""
    domain = LineDomain()
    proper = getattr(domain, method, lambda *given: OPTIONAL[method])
    setattr(domain, method, lambda *given: result(proper(*given)))
    return domain


def run_with(method, result, ticks=60):
    domain = domain_with(method, result)
    context = dataclasses.replace(line_context(), domain=domain)
    run = list(drive(context, goal="(visited a)", ticks=ticks))
    staying(domain, run[-1][0].belief, run[-1][0].command)
    return run


@pytest.mark.parametrize(("method", "result", "fault"), CASES)
def test_a_result_that_is_none_is_named_with_package_and_method(method, result, fault):
    where = rf"^the package of line: {method}( of \w+ of \w+)? returned {fault}.* \(executive/interfaces/domain.py\)$"
    with pytest.raises(UsageError, match=where):
        run_with(method, result)


def test_a_first_belief_that_is_none_is_named():
    context = dataclasses.replace(line_context(), domain=domain_with("initial_belief", lambda own: None))
    with pytest.raises(UsageError, match=r"^the package of line: initial_belief returned None, expected a belief"):
        initial_state(context)


@pytest.mark.parametrize(
    ("method", "result"),
    [
        ("anchor", set),
        ("belief_values", list),
        ("belief_values", lambda own: np.array(own, np.float32)),
        ("ready", np.bool_),
        ("value", lambda own: own and Interval(np.float64(own.lower), np.float64(own.upper))),
        ("relocations", np.int64),
        ("kept", lambda own: [0.0]),
    ],
)
def test_values_that_serve_as_well_are_taken(method, result):
    state = run_with(method, result)[-1][0]
    assert state.mode is not Mode.FAULT
    assert state.task.result == "achieved"


@pytest.mark.parametrize("message", [None, 0.5, LineBelief()])
def test_a_command_that_is_no_message_of_its_topic_is_named_with_the_method(message):
    domain = domain_with("message", lambda own: message)
    with pytest.raises(
        UsageError, match=r"^the package of line: .* returned .*, expected a VelocityCommand by the top"
    ):
        messages_of(domain, (0.0,), 1)


@pytest.mark.parametrize("wrong", [None, "high", np.zeros(3), [None] * 4])
def test_a_risk_that_is_none_is_named_with_its_function(wrong):
    def careless(subgoals, action):
        return wrong

    following = SimpleNamespace(asserted=False, variables=(), action=SimpleNamespace(subgoal_risk=careless))
    risk = risk_to_next(SimpleNamespace(asserted=True), following, ())
    with pytest.raises(UsageError, match=r"careless, a subgoal_risk, returned .*, expected one risk for each row"):
        risk(np.zeros((4, 2)))
