"""`tailor goal --wait` against an executive that answers as the test says, without a bus."""

import json
import signal
import time
from contextlib import contextmanager
from dataclasses import replace

import pytest

from tailor.runtime.bus.service import no_service
from tailor.schemas.messages import ExecStatus, Sample
from tailor.tools.commands.run import goal as command
from tailor.tools.main import main
from tests.support.injection.signals import heeded_signals

SENDER = "ab" * 16
OPEN = ExecStatus(10**9, 5, "EXECUTING", "", "line", "(visited a)", "", "slide", 0, 0.5, 3.0)
BEFORE = replace(OPEN, tick=4, goal="(visited b)", result="achieved")
DONE = replace(OPEN, tick=9, stamp_ns=3 * 10**9, mode="READY", action="", result="achieved")
FAILED = replace(DONE, result="failed", result_reason="unsolvable", result_detail="dead end")


class Bus:
    """A session whose executive publishes statuses, one each time somebody looks, and answers a goal."""

    connected = True

    def __init__(self, answers, statuses):
        self.answers, self.statuses, self.sent = answers, list(statuses), []

    def inbox(self, names, robot, newest_only=True):
        assert (names, newest_only) == (["status"], False)
        return self

    def drain(self, now_ns):
        if not self.statuses:
            return ()
        status = self.statuses.pop(0)
        return () if status is None else (Sample("exec/status", status, now_ns, status.tick, SENDER),)

    def call_all(self, key, text):
        self.sent.append(text)
        return self.answers


@pytest.fixture
def run(monkeypatch, capsys):
    def run(*words, answers=((True, "accepted"),), statuses=(BEFORE, None, OPEN, DONE)):
        bus = Bus(answers, statuses)

        @contextmanager
        def opened(arguments, role):
            assert role == "people"
            yield bus

        monkeypatch.setattr(command, "open_bus", opened)
        code = main(["goal", *words])
        return code, *capsys.readouterr(), bus.sent

    return run


def test_a_goal_is_sent_and_followed_to_its_end(run):
    lines = "EXECUTING slide\nREADY\nachieved after 2.0 s\n"
    assert run("(visited a)", "--wait") == (0, lines, "", ["(visited a)"])
    code, out, err, _ = run("--wait", statuses=(BEFORE, None, OPEN, FAILED))
    assert (code, out.splitlines()[-1], err) == (1, "failed: unsolvable: dead end after 2.0 s", "")


def test_the_status_of_the_goal_before_tells_nothing_although_it_comes_after_the_look(run):
    assert run("(visited a)", "--wait", statuses=(BEFORE, OPEN, replace(DONE, goal="(visited b)")))[0] == 1, "replaced"
    stale = replace(BEFORE, goal="(visited a)")
    assert run("--wait", statuses=(stale, replace(stale, tick=5), replace(OPEN, tick=6), FAILED))[0] == 1


def test_with_json_there_is_one_object(run):
    code, out, err, _ = run("--wait", "--json")
    ended = {"result": "achieved", "reason": "", "detail": "", "duration_s": 2.0, "problem": ""}
    assert (code, json.loads(out), err) == (0, {"accepted": True, "answer": "accepted", **ended}, "")


def test_what_nobody_tells_is_named_and_the_goal_stays_open(run):
    started_s = time.monotonic()
    code, out, err, _ = run("--wait", "--timeout", "0.2", statuses=(BEFORE, None, OPEN))
    assert (code, out) == (1, "EXECUTING slide\n")
    assert err == "no end within 0.2 s; the goal is still pursued: `tailor goal --cancel` drops it\n"
    assert time.monotonic() - started_s < 60
    code, out, err, _ = run("--wait", "--json", "--timeout", "0.1", statuses=(BEFORE, None, OPEN))
    told = json.loads(out)
    assert (code, told["result"], told["duration_s"]) == (1, "", None)
    assert told["problem"].startswith("no end within 0.1 s")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("flags", [(), ("--json",)])
def test_an_interrupted_wait_says_that_the_goal_is_pursued(run, monkeypatch, number, flags):
    monkeypatch.setattr(command.GoalFollower, "_hear", lambda self: signal.raise_signal(number))
    monkeypatch.setattr(command.GoalFollower, "look", lambda self: None)
    pursued = "the goal is still pursued: `tailor goal --cancel` drops it\n"
    with heeded_signals():
        assert run("--wait", *flags)[:3] == (128 + number, "", pursued)
        assert signal.getsignal(number) is not signal.SIG_IGN


def test_a_goal_that_has_ended_when_the_wait_is_interrupted_is_told(run, monkeypatch):
    hear = command.GoalFollower._hear

    def interrupted(self):
        heard = hear(self)
        if self.wait.result is not None:
            signal.raise_signal(signal.SIGTERM)
        return heard

    monkeypatch.setattr(command.GoalFollower, "_hear", interrupted)
    with heeded_signals():
        code, out, err, _ = run("--wait")
    assert (code, out.splitlines()[-1], err) == (0, "achieved after 2.0 s", "")


def test_a_refused_goal_and_two_executives_are_not_waited_for(run):
    code, out, err, _ = run("--wait", answers=[(False, "no goal")])
    assert (code, out, err) == (2, "", "no goal\n")
    code, out, err, _ = run("--wait", answers=[(True, "accepted"), (True, "accepted")])
    assert (code, out) == (1, "accepted\naccepted\n")
    assert err.startswith("2 executives answered, expected one: ")


def test_a_bus_that_is_lost_before_the_answer_is_named(run, monkeypatch):
    monkeypatch.setattr(Bus, "connected", False)
    code, out, err, _ = run("--wait", answers=[(False, no_service("exec/goal"))])
    assert (code, out) == (2, "")
    assert err.startswith("the bus was lost before an answer came: ")


@pytest.mark.parametrize("before", [BEFORE, FAILED])
def test_a_goal_without_conditions_is_over_when_it_is_answered(run, before):
    answers = [(True, "no goal is open")]
    assert run("(and)", "--wait", answers=answers, statuses=(before, before))[:3] == (0, "no goal is open\n", "")


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("--wait", "--cancel"), "--cancel: expected without --wait"),
        (("--timeout", "3"), "--timeout: expected with --wait"),
        (("--wait", "--timeout", "soon"), "--timeout is 'soon'"),
    ],
)
def test_flags_that_do_not_go_together_are_refused_before_anything_is_sent(run, words, named):
    code, out, err, sent = run(*words)
    assert (code, out, sent) == (2, "", [])
    assert named in err
