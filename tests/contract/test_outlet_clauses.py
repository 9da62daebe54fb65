"""A robot with two command outlets keeps the contract; for each way in which outlets can be wrong a clause fails."""

import dataclasses

import pytest

from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.outlet import outlets_of
from tailor.schemas.errors import UsageError
from tailor.tools.contract.subject import Subject
from tailor.tools.contract.suite import CLAUSES, cases
from tailor.tools.contract.trial import try_command
from tests.support.bus_system import ROOT
from tests.support.robots.known_robot import known_package

PORTER = ROOT / "tests" / "support" / "robots" / "porter"


@pytest.fixture(scope="module")
def porter():
    with known_package("depot", "porter", PORTER):
        yield


@pytest.fixture
def subject(porter):
    return Subject("depot", runs=1)


def found(subject, name):
    """Faults that a clause finds."""
    return [fault for clause, case in cases(subject) if clause.name == name for fault in clause.check(subject, case)]


def with_outlets(subject, *changes):
    """The domain with outlets that differ, one table of changes for each."""
    changed = zip(outlets_of(subject.domain), changes, strict=True)
    subject.domain.outlets = tuple(dataclasses.replace(outlet, **each) for outlet, each in changed)


def test_two_outlets_a_fixed_parameter_and_msg_files_keep_every_clause(subject):
    broken = {clause.name: list(clause.check(subject, case)) for clause, case in cases(subject)}
    assert broken == {name: [] for name in CLAUSES}


@pytest.mark.parametrize(
    ("clause", "base", "gripper", "fault"),
    [
        ("holds_together", {"name": "gripper"}, {}, "outlets: the name 'gripper' occurs twice"),
        ("holds_together", {"topic": "porter_grip"}, {}, "outlets: the topic 'porter_grip' occurs twice"),
        ("holds_together", {"topic": "porter_legs"}, {}, "outlets: there is no topic 'porter_legs'"),
        ("holds_together", {"axes": ()}, {}, "axes are not those of all outlets"),
        ("holds_together", {"name": "legs"}, {}, "drives 'base', which is none of outlets"),
        ("command_becomes_a_message", {}, {"message": lambda command, stamp_ns: None}, "porter_grip"),
    ],
)
def test_a_clause_finds_wrong_outlets(clause, base, gripper, fault, subject):
    with_outlets(subject, base, gripper)
    assert any(fault in each for each in found(subject, clause)), found(subject, clause)


def test_a_command_topic_beside_outlets_that_is_none_of_theirs_is_found(subject):
    subject.domain.command_topic = "joint_cmd"
    fault = "command_topic is 'joint_cmd', expected that of the first of outlets: porter_rail"
    assert any(fault in each for each in found(subject, "holds_together"))
    subject.domain.command_topic = "porter_rail"
    assert found(subject, "holds_together") == []


def test_kept_set_points_that_are_not_one_for_each_axis_are_found(subject):
    axes = len(subject.domain.axes)
    subject.domain.kept = lambda belief: (0.0,) * axes
    assert found(subject, "holds_together") == []
    subject.domain.kept = lambda belief: (0.0,)
    fault = f"kept returned (0.0,), expected one set-point for each of {axes} axes"
    assert any(fault in each for each in found(subject, "holds_together"))


def test_a_kept_set_point_out_of_range_is_found(subject):
    rail, width = subject.domain.axes
    wide = dataclasses.replace(width, kept=0.5)
    subject.domain.axes = (rail, wide)
    with_outlets(subject, {}, {"axes": (wide,)})
    assert any("width" in each for each in found(subject, "axes_contain_rest"))


def test_an_outlet_that_no_action_drives_is_found_and_nothing_else(subject):
    actions = {name: dataclasses.replace(each, drives=("base",)) for name, each in subject.domain.actions.items()}
    subject.domain.actions = actions
    assert found(subject, "outlets_are_driven") == ["outlet 'gripper' is driven by no action"]


def test_a_command_beyond_the_axes_of_its_outlet_is_found(subject):
    def wide(state, now_ns, belief, arguments):
        return Control(None, (0.3,), "running" if now_ns < 2e9 else "done")

    squeeze = dataclasses.replace(subject.domain.actions["Squeeze"], controller=wide)
    subject.domain.actions = {**subject.domain.actions, "Squeeze": squeeze}
    assert any("width" in each for each in found(subject, "commands_are_within_the_axes"))


def test_a_command_of_all_axes_by_an_action_that_drives_some_is_found(subject):
    """The executive refuses it, live."""

    def all_axes(state, now_ns, belief, arguments):
        return Control(None, (0.0, 0.1), "running" if now_ns < 2e9 else "done")

    squeeze = dataclasses.replace(subject.domain.actions["Squeeze"], controller=all_axes)
    subject.domain.actions = {**subject.domain.actions, "Squeeze": squeeze}
    assert found(subject, "commands_are_within_the_axes") == ["2 values, expected 1: width"]
    with pytest.raises(UsageError, match="controller of Squeeze: 2 values, expected 1: width"):
        try_command(subject.domain, "Squeeze")
