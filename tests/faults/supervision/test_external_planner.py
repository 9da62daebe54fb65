"""The executive's requests to an external planner: always an answer, and no child left behind."""

import errno
import sys
import tempfile
import time
from pathlib import Path

import pytest

from tailor.runtime.processes.external_planner import MAX_ANSWER_BYTES, ExternalPlanner
from tailor.schemas import codec
from tailor.schemas.messages import PlanAnswer, PlanRequest
from tests.faults.supervision.test_planner_process import LIMIT_S, POLL_LIMIT_S, program
from tests.support.patience import PATIENCE_S, gone
from tests.support.stalls import repeat_on_stall


def request(number=7):
    return PlanRequest(0, number, "(define (domain d))", "(define (problem p))")


def answer_of(command, limit_s=LIMIT_S):
    return repeat_on_stall(3, lambda: polled(command, limit_s))


def polled(command, limit_s):
    planner = ExternalPlanner(command, limit_s)
    planner.request(request())
    longest, ends = 0.0, time.monotonic() + limit_s + PATIENCE_S
    while time.monotonic() < ends:
        before = time.perf_counter()
        answer = planner.poll(7, 123)
        longest = max(longest, time.perf_counter() - before)
        if answer is not None:
            assert planner.poll(7, 124) is None, "an answer is given once"
            assert longest < POLL_LIMIT_S
            assert codec.decode(PlanAnswer, codec.encode(answer)) == answer, "what replay reads is what the core got"
            return answer
        time.sleep(0.005)
    raise AssertionError("no answer")


def test_a_planner_that_behaves_well_is_handed_on_with_number_and_time(tmp_path):
    answer = answer_of(program(tmp_path, "print(open(sys.argv[1]).read(), open(sys.argv[2]).read())"))
    assert answer == PlanAnswer(
        123, 7, "answered", "(define (domain d)) (define (problem p))\n", "the planner ended with code 0"
    )


@pytest.mark.promise("P8")
@pytest.mark.parametrize(
    ("body", "outcome", "reason"),
    [
        ("time.sleep(60)", "timeout", "killed after 0.5 s"),
        ("os.abort()", "crashed", "code -6"),
        ("while True: sys.stdout.write('x' * 65536)", "flood", f"more than {MAX_ANSWER_BYTES} bytes"),
        (f"sys.stdout.buffer.write(b'\\xff' * {MAX_ANSWER_BYTES})", "flood", f"more than {MAX_ANSWER_BYTES}"),
    ],
)
def test_a_planner_that_does_not_end_well_has_an_outcome_and_no_output(tmp_path, body, outcome, reason):
    answer = answer_of(program(tmp_path, body), 0.5 if outcome == "timeout" else LIMIT_S)
    assert (answer.outcome, answer.output) == (outcome, "")
    assert reason in answer.reason


def test_garbage_is_handed_on_as_text_that_survives_the_recording(tmp_path):
    answer = answer_of(program(tmp_path, "sys.stdout.buffer.write(bytes(range(256)) * 20)"))
    assert answer.outcome == "answered"
    assert "\0" in answer.output


def test_a_program_that_is_gone_at_run_time_is_an_answer_too():
    answer = answer_of("no-such-planner-anywhere -g")
    assert answer.outcome == "missing"
    assert "there is no program 'no-such-planner-anywhere'" in answer.reason


@pytest.mark.parametrize("command", ["\0", "true a\0b", "up:pyper\0plan"])
def test_a_command_with_a_nul_is_an_answer_too(command):
    answer = answer_of(command)
    assert answer.outcome == "missing"
    assert "cannot be started: it contains a NUL" in answer.reason
    assert "\0" not in answer.reason


def sleeper(tmp_path):
    return program(tmp_path, "time.sleep(60)")


def test_a_child_whose_answer_nobody_awaits_any_more_is_killed(tmp_path):
    planner = ExternalPlanner(sleeper(tmp_path), 60.0)
    planner.request(request())
    assert planner.poll(7, 0) is None
    pid = planner._child.result().pid
    assert planner.poll(0, 0) is None
    assert gone(pid)


def test_a_new_request_takes_the_place_of_the_old_one_and_closing_leaves_nothing(tmp_path):
    planner = ExternalPlanner(sleeper(tmp_path), 60.0)
    planner.request(request(1))
    first = planner._child.result().pid
    planner.request(request(2))
    assert gone(first)
    second = planner._child.result().pid
    planner.close()
    planner.close()
    assert gone(second)
    assert planner.poll(2, 0) is None


def test_closing_ends_the_thread_and_kills_a_child_that_is_being_started(tmp_path):
    planner = ExternalPlanner(sleeper(tmp_path), 60.0)
    (thread,) = planner._starter._threads
    planner.request(request())
    child = planner._child
    planner.close()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
    assert gone(child.result().pid)


def test_nothing_is_started_before_there_is_a_request():
    planner = ExternalPlanner(f"{sys.executable} -c pass", 1.0)
    assert planner.poll(0, 0) is None
    assert planner._child is None


@pytest.mark.parametrize("missing", ["the folder of temporary files", "space for the files"])
def test_a_disk_that_takes_no_files_ends_the_request_and_not_the_executive(tmp_path, monkeypatch, missing):
    def full(path, text, encoding):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    if missing == "space for the files":
        (tmp_path / "tmp").mkdir()
        monkeypatch.setattr(Path, "write_text", full)
    answer = answer_of("true")
    assert answer.outcome == "missing"
    assert "cannot be started: " in answer.reason
    assert not list(tmp_path.glob("*/tailor-planner-*"))
