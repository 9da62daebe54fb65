"""Faults of the machine under a recorder: the file stays readable, the bus continues."""

import json
import subprocess
import sys
import time

import pytest

from tailor.runtime.processes.child import Child
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas import codec
from tailor.schemas.messages import Odometry
from tests.support.bus_system import bus_system
from tests.support.patience import PATIENCE_S, wait_until

MAX_BYTES = 60_000  # of the file, then the kernel refuses as it does on a full disk
LIMITED = f"""
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, ({MAX_BYTES}, {MAX_BYTES}))
from tailor.tools.main import main
sys.exit(main(sys.argv[1:]))
"""


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
    assert recording.damage.damaged_chunks == 0


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
