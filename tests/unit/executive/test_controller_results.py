"""A controller that returns no well-formed result ends the run with one line, as one that raises does."""

import dataclasses

import numpy as np
import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.interfaces.action import Control
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import VelocityCommand
from tests.support.toy_domain import SLIDE, LineDomain, line_context
from tests.unit.executive.core.test_core import drive, messages


def run_with(result, ticks=60):
    """The ticks of a robot whose controller returns what `result` makes of the proper one."""

    def controller(state, now_ns, belief, arguments):
        return result(SLIDE.controller(state, now_ns, belief, arguments))

    domain = LineDomain()
    domain.actions = {"slide": dataclasses.replace(SLIDE, controller=controller)}
    return list(drive(dataclasses.replace(line_context(), domain=domain), goal="(visited a)", ticks=ticks))


def with_fields(**fields):
    return lambda control: dataclasses.replace(control, **fields)


@pytest.mark.parametrize(
    ("result", "fault"),
    [
        (lambda control: None, r"None, expected a Control \(executive/interfaces/action.py\)"),
        (lambda control: control.command, r"\(0.5,\), expected a Control \(executive/interfaces/action.py\)"),
        (lambda control: Control, r"<class .*>, expected a Control \(executive/interfaces/action.py\)"),
        (with_fields(command=None), "the command None, expected a tuple of numbers"),
        (with_fields(command=0.5), "the command 0.5, expected a tuple of numbers"),
        (with_fields(command="1"), "the command '1', expected a tuple of numbers"),
        (with_fields(command=("1",)), r"the command \('1',\), expected a tuple of numbers"),
        (with_fields(command=(None,)), r"the command \(None,\), expected a tuple of numbers"),
        (with_fields(command=np.zeros((1, 1))), r"the command array\(\[\[0.\]\]\), expected a tuple of numbers"),
        (with_fields(outcome="finished"), "the outcome 'finished', expected one of: running, done, failed"),
        (with_fields(outcome=None), "the outcome None, expected one of: running, done, failed"),
        (with_fields(outcome=np.zeros(2)), r"the outcome array\(\[0., 0.\]\), expected one of: running, done, failed"),
        (with_fields(outcome="failed", detail=ValueError(3)), r"the detail ValueError\(3\), expected text"),
    ],
)
def test_a_result_that_is_none_is_named_with_package_and_action(result, fault):
    with pytest.raises(UsageError, match=rf"^the package of line: the controller of slide returned {fault}$"):
        run_with(result)


@pytest.mark.parametrize("row", [list, np.array, lambda command: tuple(np.float32(each) for each in command)])
def test_a_row_of_numbers_of_any_type_is_a_command(row):
    run = run_with(lambda control: dataclasses.replace(control, command=row(control.command)))
    assert max(command.v for command in messages(run, VelocityCommand)) == pytest.approx(0.5)
    assert run[-1][0].mode is not Mode.FAULT
    assert run[-1][0].task.result == "achieved"


def test_a_long_result_stays_short():
    with pytest.raises(UsageError) as raised:
        run_with(lambda control: Control(None, ("7" * 1000,)))
    assert len(str(raised.value)) < 200
