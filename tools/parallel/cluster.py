"""Workers of a Dask cluster. Dask makes the parts of a killed worker again on the others."""

from __future__ import annotations

import argparse
import logging
import re
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.tools.parallel.pool import Numbered, Part, using
from tailor.tools.parallel.software import Work, differences, software_for

ADDRESS = re.compile(r"(tcp|tls)://[^\s/]+:(?P<port>\d{1,5})")
MAX_PORT = 65535
CONNECT_S = 5.0  # limit for the scheduler's answer, for its first worker, and for a lost scheduler to come back
ANSWER_S = 60.0  # limit for a worker to load its software, which takes seconds
KEPT = "finished parts are kept, --resume continues"


def configure_cluster(parser: argparse.ArgumentParser) -> None:
    """Declare --on."""
    parser.add_argument(
        "--on",
        type=_address,
        metavar="ADDRESS",
        help="run on the workers of the Dask scheduler at tcp://HOST:PORT or tls://HOST:PORT (docs/cluster.md); --jobs "
        "does not count then",
    )


@contextmanager
def working_on(address: str | None, work: Work) -> Iterator[None]:
    """Within the context, parts run on the cluster at `address`; without one, on this machine.

    Raises:
      ModuleNotFoundError: The extra `cluster` is missing.
      UsageError: No scheduler or no worker answers, or workers have other software; or the scheduler goes away within
        the context.
    """
    if not address:
        yield
        return
    with _connected(address) as client:
        cluster = Cluster(client, address, work)
        cluster.check_workers()
        with using(cluster):
            yield


def _connected(address: str) -> Any:
    """Client of the scheduler; its log is silent, since errors are reported in one line."""
    from distributed import Client, Security

    for name in [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == "distributed"]:
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    if address.startswith("tls") and Security().get_connection_args("client")["ssl_context"] is None:
        raise UsageError(f"--on {address}: expected certificates in Dask's settings, distributed.comm.tls")
    try:
        return Client(address, timeout=CONNECT_S, set_as_default=False)
    except OSError:
        raise UsageError(f"--on {address}: no scheduler answers within {CONNECT_S:g} s") from None


@dataclass(frozen=True, slots=True)
class Cluster:
    """A pool of workers (see `pool.Pool`), which may come and go."""

    client: Any  # distributed.Client
    address: str
    work: Work

    def completed(self, part: Part, calls: Sequence[tuple[Any, ...]], jobs: int) -> Iterator[Numbered]:
        """See `Pool.completed`.

        Raises:
          UsageError: The scheduler goes away, a worker that came later has other software, or a part ends one worker
            after another.
        """
        from distributed import as_completed

        checked = partial(_checked, self.work, software_for(self.work), part)
        with self._explained():
            futures = self.client.map(checked, calls, pure=False)
            numbers = {future.key: number for number, future in enumerate(futures)}
            running = as_completed(futures, loop=self.client.loop, with_results=True)
            del futures  # or each result would stay on its worker to the end
            for future, result in running:
                if future.cancelled():
                    raise CancelledError
                yield numbers.pop(future.key), result

    def check_workers(self) -> None:
        """Compare the software of all workers with this process.

        Raises:
          UsageError: There is no worker, or some have other software; the message names each.
        """
        try:
            self.client.wait_for_workers(1, timeout=CONNECT_S)
        except TimeoutError:
            start = f"`dask worker {self.address} --nthreads 1` starts one"
            raise UsageError(f"--on {self.address}: the scheduler has no worker; {start}") from None
        with self._explained():
            workers = self.client.scheduler_info(n_workers=-1)["workers"]
            answers = {
                name: self.client.submit(software_for, self.work, workers=[name], pure=False, allow_other_workers=False)
                for name in sorted(workers)
            }
            faults = {name: _faults(future, workers[name], self.work) for name, future in answers.items()}
        if any(faults.values()):
            each = "; ".join(f"worker {name}: {', '.join(wrong)}" for name, wrong in faults.items() if wrong)
            raise UsageError(f"--on {self.address}: {each}")

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """Errors of the cluster in one line."""
        from distributed import KilledWorker

        try:
            yield
        except KilledWorker as error:
            raise UsageError(f"--on {self.address}: {_first_line(error)} {KEPT}") from None
        except (CancelledError, OSError) as error:
            if isinstance(error, OSError) and self.client.status == "running":
                raise  # of a part
            raise UsageError(f"--on {self.address}: the scheduler went away; {KEPT}") from None


def _checked(work: Work, expected: Mapping[str, str], part: Part, call: tuple[Any, ...]) -> Any:
    """Run a part on a worker, which may have come after the first check."""
    wrong = differences(software_for(work), expected)
    if wrong:
        from distributed import get_worker

        raise UsageError(f"worker {get_worker().address}: {', '.join(wrong)}")
    return part(*call)


def _faults(answer: Any, worker: Mapping[str, Any], work: Work) -> list[str]:
    """What a worker differs in."""
    threads = worker["nthreads"]
    wrong = [f"runs {threads} parts in one process, expected --nthreads 1"] if threads != 1 else []
    try:
        error = answer.exception(timeout=ANSWER_S)
    except TimeoutError:
        return [*wrong, f"does not answer within {ANSWER_S:g} s"]
    if error is not None:
        return [*wrong, f"has no Tailor that can be used ({_first_line(error)})"]
    return [*wrong, *differences(answer.result(), software_for(work))]


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)


def _address(text: str) -> str:
    read = ADDRESS.fullmatch(text)
    if read is None or not 1 <= int(read["port"]) <= MAX_PORT:
        raise UsageError(f"--on is '{text}', expected tcp://HOST:PORT or tls://HOST:PORT, a port up to {MAX_PORT}")
    return text
