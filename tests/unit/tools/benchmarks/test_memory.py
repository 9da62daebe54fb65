"""Memory of a running system: what mlockall makes resident counts."""

import sys
import time

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, stopped_in_order, tailor
from tailor.tools.benchmarks.memory import Usage, processes_of
from tailor.tools.benchmarks.ticks import wait_for_router
from tailor.tools.launch.hosting import free_endpoint
from tests.support.patience import wait_until

LATER_MB = 0 if sys.version_info < (3, 12) else 15  # later Pythons take some 10 MB more
OWN_MB = 82 + LATER_MB
EXECUTIVE_MB = 170 + LATER_MB  # with the libraries, of which it has 69 or 77 MB, by how their files were written
OTHERS_MB = 150  # of the launcher, the simulator and the recorder each


@pytest.mark.xdist_group("systems")
@pytest.mark.parametrize("domain", ["soccer", pytest.param("arm", marks=pytest.mark.slow)])
def test_an_executive_in_motion_takes_82_mb_of_its_own_with_all_that_is_locked(tmp_path, domain):
    endpoint = free_endpoint()
    up = tailor("up", domain, "--connect", endpoint, "--record", str(tmp_path / "run.mcap"))
    with (tmp_path / "log").open("w") as log, stopped_in_order([Child("up", up, log)]) as (launcher,):
        wait_for_router(endpoint)
        with open_client(endpoint) as session:
            ticks = session.inbox(("tick",), "")
            wait_until(ticks.drain, "ticks")
            time.sleep(3.0)  # a deliberation, models called, an action running
            assert ticks.drain()
        pids = processes_of(launcher.pid)
        usage = {name: Usage.of(pid) for name, pid in pids.items()} | {"up": Usage.of(launcher.pid)}
    print({name: (round(each.own_mb), round(each.peak_mb)) for name, each in usage.items()})
    executive = usage.pop("executive")
    assert executive.own_mb <= OWN_MB
    assert executive.peak_mb <= EXECUTIVE_MB
    assert max(each.peak_mb for each in usage.values()) <= OTHERS_MB
