"""Deliberation of the ticks of an evaluation, in checks or in CPU time."""

import time

import pytest

from tailor.tools.evaluations import task_runs
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.tick_budget import tick_budget
from tailor.tools.lockstep.run import CHECKS_PER_TICK
from tailor.tools.main import main


def work(ms):
    until = time.thread_time_ns() + ms * 1_000_000
    while time.thread_time_ns() < until:
        pass


def test_by_default_a_tick_has_a_number_of_checks():
    budget = tick_budget(0.0)()
    while not budget.spent():
        pass
    assert budget.granted == CHECKS_PER_TICK


def test_a_budget_of_time_ends_after_the_cpu_time_that_was_worked():
    budget = tick_budget(20.0)()
    time.sleep(0.03)
    assert not budget.spent(), "to wait costs no CPU time"
    work(21)
    assert budget.spent()
    assert not tick_budget(20.0)().spent(), "each tick has its own"


def test_a_run_has_the_budget_of_its_task(monkeypatch):
    given = []
    monkeypatch.setattr(task_runs, "run_lockstep", lambda *_, new_budget, **__: given.append(new_budget()))
    for tick_ms in (0.0, 5.0):
        task_runs.run_task(Task("soccer", "approach-dribble", tick_ms=tick_ms), Variant("h2"), 1)
    work(6)
    assert [budget.spent() for budget in given] == [False, True]


@pytest.mark.parametrize(
    ("evaluation", "domain"), [("table3", "soccer"), ("refinement", "soccer"), ("assertion", "soccer")]
)
@pytest.mark.parametrize("value", ["0", "-1", "nan", "1e9", "fast"])
def test_impossible_times_are_refused(capsys, evaluation, domain, value):
    assert main(["evaluate", evaluation, "--domain", domain, f"--tick-ms={value}"]) == 2
    assert "--tick-ms is" in capsys.readouterr().err
