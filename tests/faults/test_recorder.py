"""Faults of the machine under a recorder: the file stays readable, the bus continues."""

import json
import os
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest

from tailor.runtime.processes.child import Child
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas import codec
from tailor.schemas.messages import Odometry
from tests.support.bus_system import bus_system, driving, guarded_robot, moving, zero_at
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.stalls import repeat_on_stall

MAX_BYTES = 80_000  # of the file, then the kernel refuses as it does on a full disk
LIMITED = f"""
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, ({MAX_BYTES}, {MAX_BYTES}))
from tailor.tools.main import main
sys.exit(main(sys.argv[1:]))
"""
SLOW = """
import os, sys, time
really, blocks = os.write, []
def slowly(file, data):
    blocks.append(len(data))
    time.sleep(4.0 if sum(blocks) > 20_000 else 0.0)
    return really(file, data)
os.write = slowly
from tailor.tools.main import main
sys.exit(main(sys.argv[1:]))
"""
DISKS = {
    "full": (LIMITED, "disk: File too large"),
    "tmpfs": (
        "import sys; from tailor.tools.main import main; sys.exit(main(sys.argv[1:]))",
        "disk: No space left on device",
    ),
    "slow": (SLOW, "disk: a write takes longer than 3 s"),
}


def noise(number):
    """Odometry that does not compress away."""
    return Odometry(number, number * 0.7310585786, -number / 7, number % 3.1, number / 11, number / 13)


@pytest.mark.promise("P9")
def test_a_full_disk_ends_the_file_not_the_recorder_and_is_reported(tmp_path):
    path = tmp_path / "full.mcap"
    with bus_system() as (session, endpoint, _), (tmp_path / "log").open("w") as log:
        options = ["record", "-o", str(path), "--connect", endpoint]
        recorder = Child("recorder", [sys.executable, "-c", LIMITED, *options], log)
        try:
            codec.prime()
            publisher = session.publisher("odom", "agilo")
            wait_until(publisher.matched, "recorder")
            times = []
            for number in range(1500):
                began = time.monotonic()
                publisher.publish(noise(number))
                times.append(time.monotonic() - began)
                time.sleep(0.001)
            assert recorder.exit_code() is None, "it goes on"
            assert sorted(times)[-15] < 0.1, "the publisher does not wait for the disk"
        finally:
            code = recorder.stop(PATIENCE_S)
    assert code == 1
    assert "disk: File too large" in (tmp_path / "log").read_text()
    assert path.stat().st_size <= MAX_BYTES
    recording = open_recording(path)
    sequences = [message.sequence for message in recording.messages()]
    assert sequences == list(range(sequences[0], sequences[-1] + 1)), "what is there is whole"
    assert len(sequences) > 100
    assert f"full.mcap: {len(sequences)} messages, " in (tmp_path / "log").read_text().splitlines()[-1]
    assert recording.damage.damaged_chunks == 0


@contextmanager
def small_disk(folder):
    """A file system of 100 kB in a folder; skips the test where this user may not mount one."""
    folder.mkdir()
    options = ["-t", "tmpfs", "-o", "size=100k", "none", str(folder)]
    if subprocess.run(["mount", *options], capture_output=True).returncode:
        pytest.skip("no right to mount a small disk; the case `full` limits the file instead")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.promise("P9")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("disk", ["full", "slow", pytest.param("tmpfs", marks=pytest.mark.slow)])
def test_the_robot_drives_on_while_the_recorders_disk_is_full_or_slow_and_it_is_reported(tmp_path, disk):
    program, report = DISKS[disk]
    with ExitStack() as stack:
        folder = stack.enter_context(small_disk(tmp_path / "disk")) if disk == "tmpfs" else tmp_path
        session, endpoint, start, trace = stack.enter_context(guarded_robot(tmp_path))
        log = stack.enter_context((tmp_path / "log").open("w"))
        options = ["record", "-o", str(folder / "run.mcap"), "--connect", endpoint]
        recorder = Child("recorder", [sys.executable, "-P", "-c", program, *options], log, notify_folder=tmp_path)
        publisher, states = session.publisher("odom", "agilo"), session.inbox(["driver"], "agilo")

        def is_reported():
            publisher.publish(noise(publisher.sequence))
            return recorder.report().status == report

        try:
            wait_until(publisher.matched, "recorder")
            driving(start, endpoint, trace)
            wait_until(is_reported, "status of the recorder", 60.0)
            repeat_on_stall(5, lambda: drives_on_for(2.0, trace, states))
            assert recorder.exit_code() is None
        finally:
            code = recorder.stop(PATIENCE_S)
        recording = open_recording(folder / "run.mcap")
        sequences = [m.sequence for m in recording.messages() if m.sender == session.sender]
        assert len(sequences) > 10
        assert sequences == sorted(set(sequences))
        assert recording.damage.damaged_chunks == 0
        assert code == 1, "it is reported at the end, too"


def drives_on_for(seconds, trace, states):
    """The guard's output, whose changes the trace holds, stays at the speed of the executive."""
    since_s = time.monotonic()
    states.drain()
    time.sleep(seconds)
    assert states.drain(), "the driver runs"
    assert moving(trace, 0.5)()
    assert zero_at(trace, since_s) is None


@pytest.mark.promise("P9")
@pytest.mark.slow
def test_a_flood_costs_the_recorder_neither_memory_nor_order(tmp_path):
    path = tmp_path / "flood.mcap"
    with bus_system() as (session, endpoint, start):
        recorder = start("tailor.tools.main", "record", "--quiet", "-o", path, "--connect", endpoint)
        publisher = session.publisher("odom", "agilo")
        wait_until(publisher.matched, "recorder")
        before_mb = memory_mb(recorder.pid)
        ends = time.monotonic() + 3.0
        while time.monotonic() < ends:
            publisher.publish(noise(publisher.sequence))
        after_mb = memory_mb(recorder.pid)
        recorder.stop(PATIENCE_S)
    sequences = [message.sequence for message in open_recording(path).messages()]
    assert after_mb - before_mb < 80  # 32 MB of queue, and what it takes to write them
    assert sequences == sorted(set(sequences))
    assert len(sequences) > 2000
    command = [sys.executable, "-P", "-m", "tailor.tools.main", "info", str(path), "--json"]
    info = json.loads(subprocess.run(command, capture_output=True, text=True, check=False).stdout)
    lost = publisher.sequence - len(sequences)
    print(f"\nflood: {publisher.sequence} sent, {lost} lost, memory +{after_mb - before_mb:.0f} MB")
    assert info["topics"][0]["lost"] <= lost, "info reports the loss"


def memory_mb(pid):
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1000


@pytest.mark.parametrize("flags", [(), ("--snapshot", "5"), ("--max-size", "1")])
def test_a_recorder_does_not_start_on_a_full_disk(tmp_path, flags):
    with bus_system() as (_, endpoint, _):
        full = LIMITED.replace(str(MAX_BYTES), "1000")
        words = ("record", "-o", tmp_path / "r.mcap", *flags, "--connect", endpoint)
        done = subprocess.run(
            [sys.executable, "-c", full, *map(str, words)], capture_output=True, text=True, timeout=PATIENCE_S
        )
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line == f"tailor record: {tmp_path}/r.mcap: File too large, expected a writable path"
    assert list(tmp_path.iterdir()) == []


def test_a_recorder_that_is_a_service_begins_on_a_full_disk_and_waits_for_room(tmp_path):
    """A service that ends with exit code 2 is not started again."""
    full, supervisor = LIMITED.replace(str(MAX_BYTES), "1000"), tmp_path / "socket"
    with bus_system() as (_, endpoint, _), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as reports:
        reports.bind(str(supervisor))
        reports.settimeout(PATIENCE_S)
        command = [sys.executable, "-c", full, "record", "-o", str(tmp_path / "r.mcap"), "--connect", endpoint]
        recorder = subprocess.Popen(command, env={**os.environ, "NOTIFY_SOCKET": str(supervisor)})
        try:
            assert b"READY=1" in reports.recv(4096)
        finally:
            recorder.terminate()
            recorder.wait(PATIENCE_S)
