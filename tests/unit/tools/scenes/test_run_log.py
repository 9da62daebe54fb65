"""Lines for people: one for each change of a mode or its reason."""

from dataclasses import replace

from tailor.schemas.messages import ExecStatus
from tailor.schemas.own import example
from tailor.tools.scenes.run_log import RunLog


def test_a_reason_whose_numbers_alone_change_is_one_line():
    holding = replace(example(ExecStatus), mode="HOLDING", reason="input stale", action="", result="")
    log, details = RunLog(), ("odom has v at 3.2", "odom has v at -2.1", "pose", "odom has v at 4")
    lines = [line.text for each in details for line in log.lines_of("exec/status", replace(holding, detail=each))]
    assert lines == [f"HOLDING input stale: {detail}" for detail in (details[0], details[2], details[3])]
