"""What `tailor up` shows of the bus: neither markup nor control characters of a message take effect."""

import sys
from dataclasses import replace

import pytest

from tailor.schemas.messages import ExecStatus, ProcessState, ProcessStates
from tailor.schemas.own import example
from tailor.tools.cli.live_status import screen

ODD = "[/bold]\x1b[31m"
SHOWN = r"[/bold]\x1b[31m"


@pytest.mark.parametrize("terminal", [False, True], ids=["lines", "panel"])
def test_names_from_the_bus_are_shown_literally(terminal, capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: terminal)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "200")
    status = replace(example(ExecStatus), action=ODD, mode="EXECUTING", reason="", result="")
    with screen() as shown:
        shown.show(ProcessStates(0, (ProcessState("sim", 1, "running", 1, 0.0, ODD, ""),)))
        shown.show(status)
    assert SHOWN in capsys.readouterr().out


def test_a_reason_whose_numbers_alone_change_is_one_line(capsys):
    """Ten lines a second of odometry that nobody believes hide whatever else happens."""
    holding = replace(example(ExecStatus), mode="HOLDING", reason="input stale", action="", result="")
    with screen() as shown:
        for detail in ("odom has v at 3.2", "odom has v at -2.1", "odom has v at 5.9e+06", "odom has omega at 9.1"):
            shown.show(replace(holding, detail=detail))
    lines = ["  HOLDING input stale: odom has v at 3.2", "  HOLDING input stale: odom has omega at 9.1"]
    assert capsys.readouterr().out.splitlines() == lines
