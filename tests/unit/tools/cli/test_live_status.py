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
