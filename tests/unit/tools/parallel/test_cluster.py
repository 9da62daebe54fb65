"""Parts on a Dask cluster: the pool's promises, tried on a scheduler and a worker in this process."""

from collections.abc import Iterator

import distributed
import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.main import main
from tailor.tools.parallel.cluster import _checked, working_on
from tailor.tools.parallel.pool import completed, in_order
from tailor.tools.parallel.software import Work, differences

NOTHING = Work(())


def cluster_of(threads: int) -> distributed.LocalCluster:
    sizes = {"n_workers": 1, "threads_per_worker": threads}
    return distributed.LocalCluster(**sizes, processes=False, protocol="tcp://", dashboard_address=":0")


@pytest.fixture(scope="module")
def cluster() -> Iterator[distributed.LocalCluster]:
    with cluster_of(threads=1) as cluster:
        yield cluster


def refuse(reason: str) -> None:
    raise UsageError(reason)


def test_results_come_with_the_numbers_of_their_calls(cluster) -> None:
    with working_on(cluster.scheduler_address, NOTHING):
        results = list(completed(divmod, [(k, 3) for k in range(7)], jobs=1))
    assert sorted(results) == [(k, divmod(k, 3)) for k in range(7)]
    assert in_order(results) == [divmod(k, 3) for k in range(7)]


def test_errors_of_a_part_are_those_of_this_machine(cluster) -> None:
    with working_on(cluster.scheduler_address, NOTHING), pytest.raises(UsageError, match=r"^no such folder$"):
        list(completed(refuse, [("no such folder",)], jobs=1))
    with working_on(cluster.scheduler_address, NOTHING), pytest.raises(FileNotFoundError):
        list(completed(open, [("/no/such/file",)], jobs=1))


def test_a_worker_that_comes_later_with_other_software_runs_nothing(cluster, tmp_path) -> None:
    with distributed.Client(cluster.scheduler_address, set_as_default=False) as client:
        other = {"Tailor": "9.9 (source 0)", "numpy": "0.1"}
        refused = client.submit(_checked, NOTHING, other, (tmp_path / "made").touch, ()).exception()
    (worker,) = cluster.workers.values()
    assert isinstance(refused, UsageError)
    assert str(refused).startswith(f"worker {worker.address}: Tailor is 0.")
    assert not (tmp_path / "made").exists()


def test_a_worker_with_threads_is_refused(capsys, tmp_path) -> None:
    with cluster_of(threads=2) as cluster:
        (worker,) = cluster.workers.values()
        command = ["gather", "agilo", "goToPose", "--out", str(tmp_path / "x"), "--on", cluster.scheduler_address]
        assert main(command) == 2
    expected = f"worker {worker.address}: runs 2 parts in one process, expected --nthreads 1"
    assert capsys.readouterr().err.strip() == f"tailor gather: --on {cluster.scheduler_address}: {expected}"
    assert not (tmp_path / "x").exists()


WRONG = ["lab-7:8786", "http://lab-7:8786", "tcp://lab-7", "tcp://lab-7:8786/x", "tcp://lab-7:0", "tcp://lab-7:87860"]


@pytest.mark.parametrize("address", WRONG)
def test_a_wrong_address_is_refused(address, capsys) -> None:
    assert main(["gather", "agilo", "--on", address]) == 2
    assert f"--on is '{address}', expected tcp://HOST:PORT or tls://HOST:PORT" in capsys.readouterr().err


def test_tls_without_certificates_is_refused(capsys) -> None:
    assert main(["gather", "agilo", "--on", "tls://127.0.0.1:1"]) == 2
    assert "expected certificates in Dask's settings, distributed.comm.tls" in capsys.readouterr().err


def test_differences_name_what_is_missing_and_what_was_expected() -> None:
    ours = {"Tailor": "1 (source a)", "numpy": "2.1", "package of truck": "source b"}
    theirs = {"Tailor": "1 (source a)", "numpy": "2.0", "package of truck": "missing (no domain 'truck')"}
    assert differences(ours, ours) == []
    assert differences(theirs, ours) == [
        "numpy is 2.0, expected 2.1",
        "package of truck is missing (no domain 'truck'), expected source b",
    ]
    assert differences({**theirs, "Tailor": "2 (source c)"}, ours) == ["Tailor is 2 (source c), expected 1 (source a)"]
