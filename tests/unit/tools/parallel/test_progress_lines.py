"""A log of long work grows while the work goes on: a line at the start and end of each step, and one a minute."""

import io
import sys

import pytest

from tailor.tools.evaluations.progress import tracked
from tailor.tools.parallel.progress_lines import EVERY_S, ProgressLines
from tailor.tools.parallel.steps import Step, counted, show


class Log(io.StringIO):
    """A file that counts flushes."""

    flushed = ""

    def flush(self) -> None:
        self.flushed = self.getvalue()


def opened(monkeypatch: pytest.MonkeyPatch) -> Log:
    """A log in the place of standard error; pytest replaces that after a fixture's set-up."""
    monkeypatch.setattr(sys, "stderr", log := Log())
    return log


def test_each_step_is_in_the_log_before_the_next_one_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    log, seen = opened(monkeypatch), []

    def steps():
        yield from counted("[a] random", iter([3, 4]), 7)
        seen.append(log.flushed)
        yield Step("training", 0, 1)
        seen.append(log.flushed)

    show(steps(), False, {}, "agilo: ")
    assert seen[0] == "agilo: [a] random: 0 of 7\nagilo: [a] random: 7 of 7\n"
    assert seen[1] == f"{seen[0]}agilo: training: 0 of 1\n"


def test_a_long_step_has_a_line_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    log, now = opened(monkeypatch), 0.0
    lines = ProgressLines(clock=lambda: now)
    for done in range(13):
        lines.report("runs", done, 12)
        now += EVERY_S / 4
    assert log.flushed.splitlines() == [f"runs: {done} of 12" for done in (0, 4, 8, 12)]


def test_runs_of_an_evaluation_are_in_the_log(monkeypatch: pytest.MonkeyPatch) -> None:
    log = opened(monkeypatch)
    running = tracked(iter("ab"), "[soccer]", 2)
    assert (next(running), log.flushed) == ("a", "[soccer]: 0 of 2\n")
    assert [*running, *tracked([], "nothing left")] == ["b"]
    assert log.flushed.splitlines()[1:] == ["[soccer]: 2 of 2"]


def test_a_quiet_command_logs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    log = opened(monkeypatch)
    show(counted("random", iter([3]), 3), True, {})
    assert log.getvalue() == ""
