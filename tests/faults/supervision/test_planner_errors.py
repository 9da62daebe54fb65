"""What an external planner writes as errors: the last line is quoted where it fails, and a flood does no harm."""

import pytest

from tailor.executive.planning import parse_plan
from tailor.runtime.processes.last_line import LastLine
from tests.faults.supervision.test_planner_process import program, run, run_without_blocking
from tests.support.patience import PATIENCE_S, interrupted_after


def reason_of(tmp_path, body):
    _, answer, _ = run(program(tmp_path, body))
    return answer.reason


@pytest.mark.parametrize(
    ("written", "quoted"),
    [
        ("'no licence'", "'no licence'"),
        ("'loading\\nno licence\\n\\n  \\n'", "'no licence'"),
        ("'\\x1b[31mred\\x07\\u202e\\r\\n'", r"'\x1b[31mred\x07\u202e'"),
        ("'x' * 100_000", f"'{'x' * 197}...'"),
    ],
)
def test_the_last_line_is_quoted_printable_and_bounded(tmp_path, written, quoted):
    assert reason_of(tmp_path, f"sys.stderr.write({written})\nsys.exit(3)") == (
        f"the planner ended with code 3 (stderr: {quoted})"
    )


def test_bytes_that_are_no_text_are_quoted_as_such(tmp_path):
    assert reason_of(tmp_path, "sys.stderr.buffer.write(b'\\xff\\x00')\nsys.exit(3)") == (
        "the planner ended with code 3 (stderr: '\ufffd\\x00')"
    )


def test_a_planner_without_a_word_has_the_plain_reason(tmp_path):
    assert reason_of(tmp_path, "sys.exit(3)") == "the planner ended with code 3"


@pytest.mark.promise("P8")
def test_a_flood_of_errors_holds_up_neither_the_planner_nor_a_poll(tmp_path):
    body = "for _ in range(1000): sys.stderr.write('x' * 999 + '\\n')\nsys.stderr.write('the end')\nprint('a plan')"
    _, answer = run_without_blocking(program(tmp_path, body))
    assert answer.output == "a plan\n"
    assert answer.reason == "the planner ended with code 0 (stderr: 'the end')"


@pytest.mark.promise("P8")
def test_errors_without_end_are_read_until_the_planner_is_killed(tmp_path):
    _, answer = run_without_blocking(program(tmp_path, "while True: sys.stderr.write('x' * 65536)"), 1.5)
    assert answer.outcome == "timeout"


def test_a_read_ends_although_there_is_always_more():
    with open("/dev/zero", "rb") as endless, interrupted_after(PATIENCE_S, "one read"):
        last = LastLine(endless)
        last.read()
    assert last.quoted() == repr("\0" * 197 + "...")


def test_a_byte_order_mark_before_the_plan_is_no_part_of_it(tmp_path):
    _, answer, _ = run(program(tmp_path, "sys.stdout.buffer.write(b'\\xef\\xbb\\xbf1:(go home)\\n')"))
    assert [step.action for step in parse_plan(answer.output).steps] == [("go", "home")]
