"""A process reports to its supervisor over systemd's protocol; only the child itself counts."""

import os
import socket
import subprocess
import sys
import time

import pytest

from tailor.runtime.processes.notify import ALIVE_PERIOD_S, Notifier
from tailor.runtime.processes.notify_socket import NotifySocket, Report
from tests.support.patience import interrupted_after, wait_until


@pytest.fixture
def receiver(tmp_path):
    receiver = NotifySocket(tmp_path / "child")
    yield receiver
    receiver.close()


def test_the_supervisor_receives_what_the_process_reports(receiver):
    notifier = Notifier(str(receiver.path))
    assert receiver.poll(os.getpid()) == Report()
    notifier.status("disk: full\nREADY=1")
    assert receiver.poll(os.getpid()) == Report(status="disk: full READY=1"), "a text reports nothing but itself"
    notifier.ready()
    notifier.alive()
    assert receiver.poll(os.getpid()) == Report(ready=True, alive=True)
    notifier.stopping()
    notifier.status("")
    assert receiver.poll(os.getpid()) == Report(stopping=True, status="")
    assert receiver.poll(os.getpid()) == Report()


def test_the_datagrams_are_those_of_systemd(tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
        systemd.bind(f"\0tailor-test-{os.getpid()}")
        notifier = Notifier(f"@tailor-test-{os.getpid()}")
        for report in (notifier.ready, notifier.alive, notifier.stopping, lambda: notifier.status("fine")):
            report()
        assert [systemd.recv(99) for _ in range(4)] == [b"READY=1", b"WATCHDOG=1", b"STOPPING=1", b"STATUS=fine"]


def test_another_process_cannot_report_for_the_child(receiver):
    stranger = (
        "import sys; from tailor.runtime.processes.notify import Notifier; n = Notifier(sys.argv[1]); n.ready();"
        "n.alive()"
    )
    subprocess.run([sys.executable, "-c", stranger, str(receiver.path)], check=True)
    assert receiver.poll(os.getpid()) == Report()


def test_a_child_of_the_process_does_not_inherit_its_socket(receiver):
    environment = {"NOTIFY_SOCKET": str(receiver.path)}
    Notifier.from_environment(environment).ready()
    assert environment == {}
    assert receiver.poll(os.getpid()).ready


@pytest.mark.parametrize("address", ["", "/nowhere/at/all", "@tailor-nobody", "x" * 300])
def test_nothing_happens_where_nobody_listens(address):
    notifier = Notifier(address)
    for report in (notifier.ready, notifier.alive, notifier.stopping, lambda: notifier.status("lost")):
        report()


def test_a_supervisor_that_does_not_read_delays_nothing_and_loses_no_readiness(receiver):
    now = iter(range(10_000))
    notifier = Notifier(str(receiver.path), lambda: next(now))
    with interrupted_after(10.0, "reports to a full queue"):
        began = time.monotonic()
        for _ in range(5000):
            notifier.alive()
        notifier.ready()
        assert time.monotonic() - began < 1.0
    wait_until(lambda: receiver.poll(os.getpid()) == Report(), "an empty queue")
    notifier.alive()
    assert receiver.poll(os.getpid()) == Report(ready=True, alive=True)


def test_a_fast_loop_reports_at_the_watchdogs_pace(receiver):
    now = [0.0]
    notifier = Notifier(str(receiver.path), lambda: now[0])
    received = 0
    for period in range(101):
        now[0] = period * ALIVE_PERIOD_S / 5
        notifier.alive()
        received += receiver.poll(os.getpid()).alive
    assert 16 <= received <= 21  # a loop of other phase loses a part of each period


def test_a_flood_of_reports_does_not_keep_the_supervisor(receiver, monkeypatch):
    monkeypatch.setattr("tailor.runtime.processes.notify_socket.MAX_DATAGRAMS", 3)
    notifier = Notifier(str(receiver.path), iter(range(10)).__next__)
    for _ in range(3):
        notifier.alive()
    notifier.ready()
    assert receiver.poll(os.getpid()) == Report(alive=True)
    assert receiver.poll(os.getpid()) == Report(ready=True)


@pytest.mark.parametrize(
    ("place", "reason"),
    [("x" * 120, "too long for a socket, expected a shorter TMPDIR"), ("absent/sim", "No such file")],
)
def test_a_socket_that_cannot_be_bound_leaves_no_descriptor_open(tmp_path, place, reason):
    before = os.listdir("/proc/self/fd")
    with pytest.raises(OSError, match=reason) as raised:
        NotifySocket(tmp_path / place)
    assert os.listdir("/proc/self/fd") == before
    del raised  # until here it keeps the socket from being collected
