"""With durations an anytime search runs beside kairos-planner, and the better of both plans counts."""

import time
from types import SimpleNamespace

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import Search, Settings, format_plan, validate
from tailor.runtime.planners.named import DURATIVE_HEAD_START
from tailor.runtime.processes import planner_process
from tailor.tools.benchmarks.execution.durative_plans import durative_problem_text
from tailor.tools.benchmarks.planning import read, texts
from tailor.tools.plan_search import sources
from tailor.tools.plan_search.limits import Limits
from tailor.tools.plan_search.sources import anytime_beside_kairos, with_kairos


class CountedLimits(Limits):
    """Limits that the search's own work reaches, so that a busy machine grants as much of it as an idle one."""

    def spent(self):
        self.granted += 1
        if self.granted > 2 * DURATIVE_HEAD_START:
            self.reached = f"{self.limit_s:g} s"
        return bool(self.reached)


def planned(problem_text, limits):
    pair = (texts("kitchen-durative-s1")[0], problem_text)
    problem = read(*pair)
    result, planner = anytime_beside_kairos(pair, problem.domain, problem, Settings(), limits)
    assert validate(result.plan, problem.domain, problem) == ""
    return result.plan, planner


def test_kairos_has_a_plan_of_eight_cups_where_the_search_has_none(capsys):
    pytest.importorskip("kairos")
    plan, planner = planned(durative_problem_text(8), CountedLimits(1.0))
    assert planner == "kairos"
    assert plan.makespan < 8 * 28
    improvement, end = capsys.readouterr().err.splitlines()[-2:]
    assert improvement == f"makespan {plan.makespan:g}, {len(plan.steps)} steps, by kairos-planner"
    assert end == "best plan found: none better within 1 s"


def test_a_plan_that_is_no_better_does_not_count(monkeypatch, tmp_path):
    domain_text, problem_text = texts("kitchen-durative-s3")
    found = Search(read(domain_text, problem_text).domain, read(domain_text, problem_text)).advance(CheckBudget(10**5))
    (tmp_path / "plan").write_text(format_plan(found.plan))
    monkeypatch.setattr(planner_process, "named_planner", lambda _: ["sh", "-c", f"cat {tmp_path}/plan"])
    assert planned(problem_text, Limits(30.0))[1] == ""


def test_nobody_waits_for_kairos_if_no_plan_is_better(monkeypatch):
    monkeypatch.setattr(planner_process, "named_planner", lambda _: ["sh", "-c", "sleep 60"])
    began = time.monotonic()
    plan, planner = planned(texts("kitchen-durative-s1")[1], Limits(30.0))
    assert (len(plan.steps), planner) == (4, "")
    assert time.monotonic() - began < 20


def test_an_interrupt_while_kairos_plans_keeps_the_plan_of_the_search(monkeypatch, capsys):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(planner_process, "named_planner", lambda _: ["sh", "-c", "sleep 60"])
    # The clock of this module alone: a planner that takes long to die is awaited by sleeping, too.
    monkeypatch.setattr(sources, "time", SimpleNamespace(sleep=interrupt, process_time=time.process_time))
    pair = texts("kitchen-durative-s3")
    problem = read(*pair)
    result, planner = anytime_beside_kairos(pair, problem.domain, problem, Settings(node_limit=200), Limits())
    assert (result.plan.makespan, planner) == (pytest.approx(56.08), "")
    assert "best plan found" in capsys.readouterr().err


@pytest.mark.parametrize("plan", [with_kairos, anytime_beside_kairos])
def test_where_the_search_has_no_plan_either_the_reason_of_kairos_is_told(monkeypatch, plan):
    failing = ["sh", "-c", "echo 'out of luck'; exit 3"]
    monkeypatch.setattr(planner_process, "named_planner", lambda _: failing)
    pair = (texts("kitchen-durative-s1")[0], durative_problem_text(8))
    problem = read(*pair)
    result, planner = plan(pair, problem.domain, problem, Settings(), CountedLimits(30.0))
    assert (result.plan, planner) == (None, "")
    assert result.reason == "no plan within 30 s; kairos-planner: the planner ended with code 3: 'out of luck'"


def test_no_planner_starts_after_the_time_limit(monkeypatch):
    monkeypatch.setattr(planner_process, "named_planner", lambda _: pytest.fail("started"))
    pair = texts("kitchen-durative-s1")
    problem = read(*pair)
    result, _ = with_kairos(pair, problem.domain, problem, Settings(), Limits(0.0))
    assert result.reason == "no plan within 0 s"
