"""Runs the parts of a work in parallel, on whatever pool is in use: by default, processes of this machine.

A part is a call of a module's function; it returns its result and writes nothing, so it may run on another machine, and
again if a worker is killed. Whoever iterates over the results writes them.
"""

from __future__ import annotations

import os
import re
import signal
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from operator import itemgetter
from traceback import extract_tb
from typing import Any, Protocol

from tailor.runtime.processes.parent_death_signal import request_at_parents_death
from tailor.schemas.errors import UsageError
from tailor.tools.parallel.quiet_shutdown import quieten_shutdown

Part = Callable[..., Any]  # can be pickled
Numbered = tuple[int, Any]  # index of a call, and its result


class Pool(Protocol):
    """A place where parts run."""

    def completed(self, part: Part, calls: Sequence[tuple[Any, ...]], jobs: int) -> Iterator[Numbered]:
        """Results of `part(*call)` as they complete, each with the index of its call.

        Args:
          part: Function of a module.
          calls: Arguments of each call.
          jobs: Number of processes, -1 for one per core; a pool with a size of its own ignores it.

        Raises:
          UsageError: The pool has lost processes.
        """
        ...


class Processes:
    """Processes of this machine."""

    def completed(self, part: Part, calls: Sequence[tuple[Any, ...]], jobs: int) -> Iterator[Numbered]:
        """See `Pool.completed`; runs on the active joblib backend."""
        from multiprocessing import resource_tracker

        from joblib import Parallel, delayed

        if jobs != 1:
            quieten_shutdown()
            resource_tracker.ensure_running()  # starting it with the first worker, it would let interrupts through
        warnings.filterwarnings("ignore", ".*adjusting the input task")  # an interrupted command reports what it kept
        # loky replaces a worker that has waited for minutes, or has grown; one that was killed ends the command
        warnings.filterwarnings("ignore", "A worker stopped while some jobs")
        # in batches of one: a result that waits for others of its batch is lost with the process
        parallel = Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
        with _holding_interrupts():
            numbered = (delayed(_numbered)(os.getpid(), k, part, call) for k, call in enumerate(calls))
            running: Iterator[Numbered] = parallel(numbered)
        return _unless_killed(running)


def _unless_killed(results: Iterator[Numbered]) -> Iterator[Numbered]:
    """The results.

    Raises:
      UsageError: A process that computes them was killed, as by Linux for lack of memory.
    """
    try:
        yield from results
    except BrokenProcessPool:
        what = "a process of this command was killed, perhaps for lack of memory"
        raise UsageError(f"{what}: fewer --jobs need less; finished parts are kept") from None
    except Exception as error:
        _note_lines(error, _lines_in(str(getattr(error.__cause__, "tb", ""))))  # of one that was pickled without it
        raise


@contextmanager
def _holding_interrupts() -> Iterator[None]:
    """Within the context, SIGINT and SIGTERM wait; processes and threads that start there never receive them.

    Ctrl-C reaches every process of a terminal, and SIGTERM often a whole group. This one ends the others, which would
    print a traceback each: blocked from their first instruction on, since they would fail while they import, too.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


_IN_USE: ContextVar[Pool] = ContextVar("pool", default=Processes())  # noqa: B039 (immutable: it has no state)


@contextmanager
def using(pool: Pool) -> Iterator[None]:
    """Within the context, parts run on this pool."""
    token = _IN_USE.set(pool)
    try:
        yield
    finally:
        _IN_USE.reset(token)


def completed(part: Part, calls: Sequence[tuple[Any, ...]], jobs: int) -> Iterator[Numbered]:
    """Results on the pool in use; see `Pool.completed`."""
    return _IN_USE.get().completed(part, calls, jobs)


def in_order(results: Iterable[Numbered]) -> list[Any]:
    """All results in the order of their calls."""
    return [result for _, result in sorted(results, key=itemgetter(0))]


def _numbered(waiting: int, number: int, part: Part, call: tuple[Any, ...]) -> Numbered:
    """A part's result; what it raises gets the lines that it came through, as `raised_at`."""
    _end_with(waiting)
    try:
        return number, part(*call)
    except Exception as error:
        _note_lines(error, [(line.filename, line.lineno) for line in extract_tb(error.__traceback__)])
        raise


def _end_with(waiting: int) -> None:
    """Have the kernel end this process with the one that waits for it, if that is its parent.

    Of a command that was killed, workers would stay for five minutes, with their memory and its standard output.
    """
    if os.getppid() == waiting:
        request_at_parents_death(signal.SIGKILL)


def _note_lines(error: Exception, lines: list[Any]) -> None:
    """Let an error tell the lines in which it was raised: on its way to another process it loses its traceback."""
    if lines and not hasattr(error, "raised_at"):
        with suppress(AttributeError):  # of a class that takes no attributes
            error.raised_at = lines  # type: ignore[attr-defined]


def _lines_in(printed: str) -> list[tuple[str, int]]:
    """The lines that a printed traceback names."""
    return [(file, int(line)) for file, line in re.findall(r'^ *File "(.+)", line (\d+)', printed, re.MULTILINE)]
