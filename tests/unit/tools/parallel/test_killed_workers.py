"""A worker that is killed, as Linux does where memory lacks, ends the command with one line."""

from __future__ import annotations

import os
import signal

import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.parallel.pool import completed, in_order


def killed(number: int) -> int:
    if number == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def test_a_killed_worker_is_reported_in_one_line_and_the_next_work_has_workers() -> None:
    with pytest.raises(UsageError, match="was killed, perhaps for lack of memory: fewer --jobs need less") as raised:
        in_order(completed(killed, [(0,), (1,), (2,)], 2))
    assert "\n" not in str(raised.value)
    assert in_order(completed(killed, [(0,), (2,)], 2)) == [0, 2]
