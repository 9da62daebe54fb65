"""A worker that is killed, as Linux does where memory lacks, ends the command with one line; so does what raises."""

from __future__ import annotations

import json
import os
import signal
import warnings
from dataclasses import replace

import pytest

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.tools.lockstep import blame
from tailor.tools.parallel.pool import completed, in_order


def killed(number: int) -> int:
    if number == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def lost(number: int) -> int:
    return json.loads("" if number else "0")


def lost_key(number: int) -> int:
    return [0][number]


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize(("part", "text"), [(lost, "JSONDecodeError: .*"), (lost_key, "IndexError: list index .*")])
def test_what_a_package_raises_in_a_worker_is_one_line_that_names_it_and_its_line(
    jobs, part, text, monkeypatch
) -> None:
    spec = replace(spec_of("soccer"), package="lorry", domain=f"{__name__}:make")
    monkeypatch.setattr(blame, "spec_of", lambda name: spec)
    with (
        pytest.raises(UsageError, match=rf"^the package of haul cannot be run: {text} \(test_killed_workers.py, line"),
        blame.blamed_on_run("haul", parts_alone=True),
    ):
        in_order(completed(part, [(0,), (1,)], jobs))


@pytest.mark.parametrize("parts_alone", [True, False])
def test_what_is_no_mistake_of_a_package_stays_as_it_is(parts_alone) -> None:
    for name in ("soccer", "no such domain"):
        with pytest.raises(json.JSONDecodeError), blame.blamed_on_run(name, parts_alone):
            in_order(completed(lost, [(1,)], 1))
    with pytest.raises(UsageError, match=r"^expected$"), blame.blamed_on_run("soccer", parts_alone):
        raise UsageError("expected")


def test_a_commands_own_error_is_none_of_the_package(monkeypatch) -> None:
    monkeypatch.setattr(blame, "spec_of", lambda name: replace(spec_of("soccer"), package="lorry"))
    with pytest.raises(OSError, match="disk"), blame.blamed_on_run("haul", parts_alone=True):
        raise OSError("disk")


def test_a_killed_worker_is_reported_in_one_line_and_the_next_work_has_workers() -> None:
    with pytest.raises(UsageError, match="was killed, perhaps for lack of memory: fewer --jobs need less") as raised:
        in_order(completed(killed, [(0,), (1,), (2,)], 2))
    assert "\n" not in str(raised.value)
    assert in_order(completed(killed, [(0,), (2,)], 2)) == [0, 2]


def test_a_worker_that_was_replaced_is_no_news() -> None:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        in_order(completed(lost, [(0,)], 1))
        warnings.warn("A worker stopped while some jobs were given to the executor. This can be", stacklevel=1)
    assert told == []
