"""The whole soccer system as a user starts it: real processes, bus, physics and models."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from contextlib import nullcontext, suppress
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains
from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.messages import ArmRequest, DriverState, ExecStatus, VelocityCommand
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tests.support.bus_system import ROOT, answers, bus_system, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.stalls import StallMeter, repeat_on_stall

LIMIT_S = 0.3 + 0.1  # the guard's time-out and one period
END_S = 5.0


def command(*arguments, timeout=2 * PATIENCE_S):
    return subprocess.run(tailor(*map(str, arguments)), capture_output=True, text=True, timeout=timeout, cwd=ROOT)


def children_of(pid):
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout
    return [int(word) for word in listed.split()]


@pytest.fixture(scope="module")
def measured_run(tmp_path_factory):
    """A recording of a live run from start to goal, and the meter of stalls meanwhile."""
    with StallMeter() as meter:
        path = live_run(tmp_path_factory.mktemp("run") / "run.mcap")
    return path, meter


@pytest.fixture(scope="module")
def recording(measured_run):
    return measured_run[0]


@pytest.fixture(scope="module")
def beside_opponents(tmp_path_factory):
    """A recording of a live run on the worker of systems, for tests that compute for long."""
    return live_run(tmp_path_factory.mktemp("run") / "opponents.mcap", "--scenario", "opponents")


def live_run(path, *more):
    flags = ("--once", "--seed", 1, "--record", path, "--connect", free_endpoint(), *more)
    done = command("up", "soccer", *flags)
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "achieved"), done.stdout + done.stderr
    return path


@pytest.mark.promise("P35")
@pytest.mark.xdist_group("live")
def test_recorded_live_run_is_repeated_by_the_core_bit_for_bit(recording):
    done = command("verify", recording, "--json")
    verdict = json.loads(done.stdout)[0]
    assert done.returncode == 0
    assert verdict["difference"] is None
    assert verdict["ticks"] > 50
    assert verdict["compared"] > 2 * verdict["ticks"]


@pytest.mark.xdist_group("systems")
def test_a_run_beside_opponents_is_repeated_too(beside_opponents):
    verified = command("verify", beside_opponents, "--json")
    assert verified.returncode == 0
    assert json.loads(verified.stdout)[0]["difference"] is None


@pytest.mark.xdist_group("systems")
def test_two_runs_from_the_recorded_inputs_equal_it_and_each_other_byte_for_byte(beside_opponents, tmp_path):
    """Record A == record B == replay(A): the equation that defines determinism, in processes of their own."""
    from tailor.tools.recordings.recorded_run import RecordedRuns

    runs = [tmp_path / "first.mcap", tmp_path / "second.mcap"]
    for seed, path in enumerate(runs, start=1):
        other_hashes = {**os.environ, "PYTHONHASHSEED": str(seed)}
        verifying = tailor("verify", str(beside_opponents), "--output", str(path))
        subprocess.run(verifying, env=other_hashes, check=True, cwd=ROOT, capture_output=True)
    assert runs[0].read_bytes() == runs[1].read_bytes()
    live, again = (RecordedRuns(path).runs[0] for path in (beside_opponents, runs[0]))
    assert (
        live.published.keys()
        == again.published.keys()
        >= {"agilo/cmd_vel", "exec/plan", "exec/subgoals", "exec/status"}
    )
    for key, messages in live.published.items():
        assert [message.data for message in messages] == [message.data for message in again.published[key]], key
    assert command("verify", runs[0]).returncode == 0


@pytest.mark.xdist_group("live")
def test_verify_names_the_first_tick_that_differs(recording):
    from tailor.executive.composition import rebuild_context
    from tailor.tools.recordings.recorded_run import RecordedRuns
    from tailor.tools.recordings.verification import verify

    runs = RecordedRuns(recording)
    run = runs.runs[0]
    other = {**run.provenance, "config": json.loads(json.dumps(run.provenance["config"]))}
    other["config"]["settings"]["refinement"]["horizon"] = 1
    difference = verify(runs, run, rebuild_context(other)).difference
    assert difference is not None
    assert difference.key in ("exec/refinement", "exec/subgoals")
    assert difference.tick < 20


@pytest.mark.xdist_group("live")
def test_a_live_run_states_the_source_of_its_executive(recording):
    from tailor.schemas.installed.core_source import core_source
    from tailor.tools.recordings.recorded_run import RecordedRuns

    assert RecordedRuns(recording).runs[0].provenance["source"]["folders"] == core_source("soccer")


@pytest.mark.xdist_group("live")
def test_no_tick_is_missed(measured_run, tmp_path):
    from tailor.tools.recordings.recorded_run import RecordedRuns

    recordings = iter([measured_run[0], tmp_path / "second.mcap", tmp_path / "third.mcap"])
    meters = iter([nullcontext(measured_run[1]), StallMeter()])

    def complete():
        path = next(recordings)
        if not path.exists():
            live_run(path)
        assert sum(report.skipped for report in RecordedRuns(path).runs[0].ticks) == 0

    repeat_on_stall(3, complete, meters.__next__)


@pytest.mark.xdist_group("live")
def test_ticks_are_counted_and_every_input_has_a_number(recording):
    from tailor.tools.recordings.recorded_run import RecordedRuns

    run = RecordedRuns(recording).runs[0]
    assert [report.tick for report in run.ticks] == list(range(1, len(run.ticks) + 1))
    assert all(number > 0 for report in run.ticks for number in report.input_sequences)


@pytest.fixture
def launched():
    """Starts systems; where a test fails before they end, they end with it."""
    systems = []

    def start(*flags):
        systems.append(subprocess.Popen(tailor("up", "soccer", *flags), stdout=subprocess.PIPE, text=True, cwd=ROOT))
        return systems[-1]

    yield start
    for up in systems:
        if up.poll() is None:
            up.terminate()
            up.communicate(timeout=PATIENCE_S)


@pytest.mark.promise("P11")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("sent", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_ctrl_c_sends_a_zero_command_closes_the_file_and_leaves_no_process(launched, tmp_path, sent, measured):
    path, endpoint = tmp_path / "run.mcap", free_endpoint()
    flags = ("--seed", "1", "--record", str(path), "--connect", endpoint)
    up = launched(*flags)
    wait_until(lambda: answers(endpoint), "router")
    with open_client(endpoint, role="people") as session:
        truth = session.inbox(("truth",), "agilo")
        wait_until(lambda: any(s.message.v > 0.2 for s in truth.drain()), "robot moves")
    processes = children_of(up.pid)
    assert len(processes) == 6  # gateway, recorder, simulator, executive, scene, and the one that kills orphans
    up.send_signal(sent)
    sent_s = time.monotonic()
    assert up.wait(PATIENCE_S) == 0
    measured.add(time.monotonic() - sent_s, END_S, what="to the end")
    assert not [pid for pid in processes if os.path.exists(f"/proc/{pid}")]
    from tailor.runtime.recordings.recording import open_recording

    commands = [m for _, m in open_recording(path).decoded() if isinstance(m, VelocityCommand)]
    assert max(c.v for c in commands) > 0.2
    assert (commands[-1].v, commands[-1].omega) == (0.0, 0.0)


@pytest.mark.xdist_group("live")
def test_ctrl_c_while_the_simulator_starts_is_a_stop_and_no_failure(launched):
    flags = ("--seed", "1", "--no-scene", "--connect", free_endpoint())
    up = launched(*flags)
    wait_until(lambda: b"\0sim\0" in b"".join(command_lines(up.pid)), "start of the simulator")
    up.send_signal(signal.SIGINT)
    printed, _ = up.communicate(timeout=PATIENCE_S)
    assert (up.returncode, printed.splitlines()[-1]) == (0, "stopped")


def command_lines(parent):
    """Command lines of the children that have not ended."""
    for pid in children_of(parent):
        with suppress(OSError):
            yield Path(f"/proc/{pid}/cmdline").read_bytes()


LEAVE = "1e" * 16


class Live:
    """Simulator and executives on a bus, with what they say of themselves."""

    def __init__(self, session, endpoint):
        self.session = session
        self.endpoint = endpoint
        self.inbox = session.inbox(("driver", "status", "truth"), "agilo")
        self.arming = session.publisher("arm_request", "agilo")
        self.latest = {}
        self.stopped_s = None
        self.leaves = iter([("--sender", LEAVE)])  # for the first executive alone

    def update(self):
        for sample in self.inbox.drain():
            message = sample.message
            self.latest[type(message)] = message
            if isinstance(message, DriverState) and message.mode == "stopped" and self.stopped_s is None:
                self.stopped_s = sample.arrival_ns / 1e9
        return self.latest

    def driver(self, mode):
        return lambda: getattr(self.update().get(DriverState), "mode", "") == mode

    def moves(self):
        status, truth = self.update().get(ExecStatus), self.latest.get(SoccerGroundTruth)
        return status is not None and status.mode == "EXECUTING" and truth is not None and truth.v > 0.2

    def put_back(self):
        """Robot and ball where they were at the start; the driver stays as it is."""
        _, start = domains.load_scenario("soccer", "approach-dribble", np.random.default_rng([0, 0]))
        assert self.session.call("agilo/sim/place", json.dumps({**start, "v": 0.0}))[0]

    def executive(self, *flags):
        self.latest.clear()
        flags += next(self.leaves, ())
        return Child("executive", tailor("executive", "soccer", "--connect", self.endpoint, *flags))


@pytest.fixture
def live():
    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "sim", "agilo", "--connect", endpoint, "--leave", LEAVE)
        found = Live(session, endpoint)
        wait_until(found.driver("disarmed"), "simulator")
        yield found


def killed_in_motion(live, after_s):
    """Kills a driving executive; seconds to the guard's stop, which are between the bounds whatever stalls."""
    live.put_back()
    stopped_before = live.driver("stopped")()
    executive = live.executive()
    try:
        if stopped_before:  # somebody has to arm it again
            status = wait_until(lambda: live.update().get(ExecStatus), "status")
            time.sleep(0.3)
            assert live.driver("stopped")(), "a new executive does not arm a stopped robot"
            live.arming.publish(ArmRequest(arm=True, reset=False, sender=status.sender, epoch=0))
        wait_until(live.moves, "robot moves")
        time.sleep(after_s)
        live.update()
        live.stopped_s, before_s = None, time.monotonic()
    finally:
        executive.kill()
    killed_s = time.monotonic()
    wait_until(lambda: live.update() and live.stopped_s, "guard stops")
    assert live.stopped_s - killed_s <= LIMIT_S
    assert live.stopped_s - before_s > 0.15, "a lost command must not stop the robot"
    return live.stopped_s - killed_s


@pytest.mark.promise("P1")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("kills", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_robot_stops_in_time_after_kill_9_of_the_executive_in_motion(live, kills, measured):
    phases = random.Random(3)
    for _ in range(kills):
        killed = partial(killed_in_motion, live, phases.uniform(0.0, 0.2))
        measured.add(repeat_on_stall(3, killed), LIMIT_S)


@pytest.mark.promise("P14")
@pytest.mark.xdist_group("live")
def test_a_second_executive_on_the_same_bus_does_not_move_the_robot(live):
    first = live.executive("--scenario", "waypoints")
    wait_until(live.moves, "robot moves")
    armed = live.latest[DriverState].armed_sender
    second = Child("second", tailor("executive", "soccer", "--seed", "9", "--connect", live.endpoint))
    senders = set()

    def both():
        live.update()
        senders.add(live.latest[ExecStatus].sender)
        return len(senders) == 2

    wait_until(both, "second executive")
    time.sleep(1.0)
    live.update()
    assert live.latest[DriverState].armed_sender == armed
    first.kill()
    wait_until(live.driver("stopped"), "guard stops")
    wait_until(lambda: abs(live.update()[SoccerGroundTruth].v) < 0.02, "robot at rest")
    time.sleep(0.5)
    assert live.update()[DriverState].mode == "stopped", "the second one must not take over by itself"
    assert abs(live.latest[SoccerGroundTruth].v) < 0.02
    second.kill()
