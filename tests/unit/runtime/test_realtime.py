"""Privileges of a real-time process, in a process of its own."""

import errno
import json
import os
import subprocess
import sys
import weakref

import pytest

from tailor.runtime import realtime
from tailor.runtime.gc_freeze import gc_disabled, gc_frozen
from tailor.runtime.realtime import MAX_OLD_OBJECTS, OLD_TICKS, collect_garbage, inherited_fifo
from tailor.schemas.errors import UsageError
from tests.support.bus_system import free_endpoint
from tests.support.patience import PATIENCE_S

REPORT = """
import gc, json, os
from tailor.runtime.realtime import prepare
before = {"policy": os.sched_getscheduler(0)}
granted = prepare()
after = {"policy": os.sched_getscheduler(0), "gc": gc.isenabled(), "frozen": gc.get_freeze_count()}
locked = next(line for line in open("/proc/self/status") if line.startswith("VmLck")).split()[1]
print(json.dumps({"granted": granted, "after": after, "locked_kb": int(locked), "fifo": os.SCHED_FIFO}))
"""


def test_granted_privileges_are_reported_and_nothing_is_raised():
    out = subprocess.run([sys.executable, "-c", REPORT], capture_output=True, text=True, check=True).stdout
    found = json.loads(out)
    granted, after = found["granted"], found["after"]
    assert granted["gc"] == "frozen"
    assert not after["gc"]
    assert after["frozen"] > 1000
    assert (granted["memory"] == "locked") == (found["locked_kb"] > 0)
    got_fifo = after["policy"] & 0xFF == found["fifo"]
    assert granted["scheduler"] == "fifo 50" if got_fifo else granted["scheduler"].startswith("default: ")


def test_without_privileges_the_refusals_are_reported():
    without = (
        "import resource, os\n"
        "resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))\n"
        "resource.setrlimit(resource.RLIMIT_MEMLOCK, (65536, 65536))\n"
        "if os.geteuid() == 0: os.setuid(65534)\n"
    )
    out = subprocess.run([sys.executable, "-c", without + REPORT], capture_output=True, text=True, check=False)
    if out.returncode:  # nobody may not be allowed to read the interpreter's files
        assert "Permission denied" in out.stderr or "ModuleNotFoundError" in out.stderr, out.stderr
        return
    granted = json.loads(out.stdout)["granted"]
    assert granted["memory"].startswith("not locked: limited to 65536")
    assert granted["scheduler"].startswith("default: ")


ELEVATED = """
import json, os, sys, time
from contextlib import suppress
from pathlib import Path
from tailor.runtime.bus import opening

def threads():
    found = {}
    for thread in Path("/proc/self/task").iterdir():
        with suppress(FileNotFoundError, ProcessLookupError):  # zenoh ends idle ones
            found[int(thread.name)] = (thread / "comm").read_text().strip(), os.sched_getscheduler(int(thread.name))
    return found

before = threads()
if sys.argv[2] == "none has run":  # as on a busy machine: none has named itself yet when it is looked for
    opening.elevate_bus_threads = lambda: None
with getattr(opening, sys.argv[4])(sys.argv[1]):
    ends = time.monotonic() + float(sys.argv[3])
    while not {"rx-0", "tx-0", "net-0"} <= {name for name, _ in threads().values()} and time.monotonic() < ends:
        time.sleep(0.01)
    after = threads()
print(json.dumps({
    "names": [name for name, _ in after.values()],
    "policies": [policy for number, (_, policy) in after.items() if number not in before],
    "own": [after[number][1] == policy for number, (_, policy) in before.items() if number in after],
}))
"""


@pytest.mark.parametrize("seen", ["all have run", "none has run"])
@pytest.mark.parametrize("router", ["open_router", "open_local_router"])
def test_a_routers_threads_are_not_starved_by_ordinary_work(router, seen):
    out = subprocess.run(
        [sys.executable, "-c", ELEVATED, free_endpoint(), seen, str(PATIENCE_S), router],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    found = json.loads(out)
    assert {"rx-0", "tx-0", "net-0"} <= set(found["names"])
    assert all(found["own"]), "threads that ran before keep their scheduling"
    allowed = subprocess.run(
        [sys.executable, "-c", "import os; os.sched_setscheduler(0, 1, os.sched_param(1))"], capture_output=True
    )
    if allowed.returncode:
        pytest.skip("SCHED_FIFO is not granted here")
    assert set(found["policies"]) == {os.SCHED_FIFO}


@pytest.mark.parametrize("granted", [True, False])
def test_an_error_meanwhile_leaves_the_scheduling_as_before_and_names_no_refusal(monkeypatch, granted):
    requests = []

    def request(thread, policy, parameters):
        requests.append((policy, parameters.sched_priority))
        if not granted:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", request)
    before = os.sched_getscheduler(0), os.sched_getparam(0).sched_priority
    with pytest.raises(UsageError) as raised, inherited_fifo(7):
        raise UsageError("the port is in use")
    assert requests == [(os.SCHED_FIFO, 7), before][: 1 + granted]
    assert raised.value.__context__ is None


@pytest.mark.parametrize("when", ["its name is read", "it is scheduled"])
def test_a_thread_of_the_bus_that_ends_meanwhile_leaves_the_others_elevated(monkeypatch, when):
    """The kernel knows no such process then; with a name that was opened before, too."""
    ending, elevated = 7, []
    threads = {6: "rx-0", ending: "tx-0", 8: "net-0"}

    def ends(number):
        if number == ending:
            raise ProcessLookupError(errno.ESRCH, "No such process")

    def name_of(path):
        if when == "its name is read":
            ends(int(path.parent.name))
        return f"{threads[int(path.parent.name)]}\n"

    def schedule(number, policy, parameters):
        ends(number)
        elevated.append(number)

    monkeypatch.setattr(realtime.Path, "iterdir", lambda folder: iter([folder / str(number) for number in threads]))
    monkeypatch.setattr(realtime.Path, "read_text", name_of)
    monkeypatch.setattr(os, "sched_setscheduler", schedule)
    assert realtime.elevate_bus_threads() == "fifo 40, 2 threads"
    assert elevated == [6, 8]


class Cycle:
    """Refers to itself through its generator."""

    def __init__(self):
        self.work = self.steps()
        next(self.work)

    def steps(self):
        yield self


@pytest.fixture
def old_cycle():
    """A reference to an abandoned cycle that earlier collections have passed on; what is loaded is frozen, as live."""
    with gc_frozen(), gc_disabled():
        cycle = Cycle()
        for tick in range(1, 20):
            collect_garbage(tick)
        abandoned = weakref.ref(cycle)
        del cycle
        yield abandoned


def test_garbage_that_has_lived_for_many_ticks_is_collected_in_ten_seconds(old_cycle):
    for tick in range(20, 20 + OLD_TICKS):
        collect_garbage(tick)
    assert old_cycle() is None


def test_old_garbage_waits_while_so_much_is_alive_that_its_collection_would_delay_a_tick(old_cycle):
    alive = [[] for _ in range(MAX_OLD_OBJECTS)]
    for tick in (1, 2, OLD_TICKS):
        collect_garbage(tick)
    assert old_cycle() is not None
    alive.clear()
    collect_garbage(2 * OLD_TICKS)
    assert old_cycle() is None
