"""Runs whole systems under faults, one a minute, and judges them all the time; see schedule.py and judging/motion.py.

Two systems run beside each other, soccer and arm, each as `tailor up` starts it: launcher with the router, recorder,
simulator, executive. People (this program) give them tasks at random starts, and arm them after each stop, once nothing
has moved for two seconds. Everything happens in one thread, which polls both systems while it waits for anything.
"""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tailor.tools.soak.faults.kinds import FAULTS
from tailor.tools.soak.faults.scene import FaultRecord, Scene
from tailor.tools.soak.judging.robots import ROBOTS, Robot
from tailor.tools.soak.judging.violations import Invariant, Violation
from tailor.tools.soak.party import Party, Result
from tailor.tools.soak.schedule import Planned
from tailor.tools.soak.stalls import Stalls
from tailor.tools.soak.systems.people import People
from tailor.tools.soak.systems.system import System
from tailor.tools.soak.systems.tasks import tasks_of
from tailor.tools.soak.tracking import follow
from tailor.tools.soak.watch import Watch

POLL_S = 0.02
STALL_WINDOW_S = 5.0
START_S = 60.0
MOVING_S = 20.0  # a fault waits so long for a robot in motion
MOVING_NS = 300_000_000


class Soak:
    """One soak; `run` once."""

    def __init__(self, seed: int, folder: Path, progress: Callable[[float, str], None]) -> None:
        """Nothing runs yet.

        Args:
          seed: Seed of tasks and faults' details.
          folder: Place for recordings and logs.
          progress: Receives the time in seconds, and a line for each event or "".
        """
        self.result = Result(seed)
        self._draw = random.Random(seed)
        self._progress = progress
        self._began_s = time.monotonic()
        self._stalls = Stalls()
        self._startup_s = START_S
        self.parties = {robot.name: self._party(robot, folder) for robot in ROBOTS}

    def run(self, planned: list[Planned], duration_s: float) -> Result:
        """Start the systems, inject the planned faults, end the systems."""
        try:
            self._begin()
            for each in planned:
                self.wait(lambda: False, each.at_s - self._elapsed_s())
                self._inject(each)
            self.wait(lambda: False, duration_s - self._elapsed_s())
        finally:
            self.result.duration_s, self.result.worst_stall_s = self._elapsed_s(), self._stalls.worst_s
            for party in self.parties.values():
                self._end(party)
        return self.result

    def wait(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Look after all systems until the condition holds, at most so long; whether it holds."""
        ends_s = time.monotonic() + seconds
        while not condition():
            if time.monotonic() >= ends_s:
                return False
            self._poll()
            self._stalls.sleep(POLL_S)
        return True

    def restart(self, system: System, sign: signal.Signals) -> None:
        """End a system with a signal for its launcher, and start it with another scenario."""
        party = self.parties[system.robot.name]
        self._end(party, sign)
        self._start(party)

    def _begin(self) -> None:
        for party in self.parties.values():
            self._start(party)
        for party in self.parties.values():
            self.wait(partial(self._heard, party), START_S)
        self._startup_s = self._elapsed_s()
        self._began_s = time.monotonic()

    def _party(self, robot: Robot, folder: Path) -> Party:
        report = partial(self._violated, robot.name)
        system = System(robot, folder, report)
        return Party(system, People(system, tasks_of(system, self._draw)), Watch(system, report))

    def _start(self, party: Party) -> None:
        tasks = tasks_of(party.system, self._draw)
        party.people = People(party.system, tasks)
        party.system.start(tasks.scenario, self._draw.randrange(1000))
        party.watch.started(time.monotonic_ns())
        party.ending = False

    def _end(self, party: Party, sign: signal.Signals = signal.SIGINT) -> None:
        party.ending = True
        party.tasks += party.people.count
        party.faults += party.people.faults
        end = party.system.end(self.wait, sign)
        robot, now_ns = party.system.robot.name, time.monotonic_ns()
        expected = 0 if sign is signal.SIGINT else -sign
        if end.code != expected or end.left:
            detail = f"exit code {end.code} after {end.took_s:.1f} s, left behind: {end.left or 'none'}"
            self._violated(robot, now_ns, Invariant.ORDERLY_END, detail)

    def _poll(self) -> None:
        for party in self.parties.values():
            if party.ending:
                continue
            party.system.poll()
            self._note_stop(party)
            party.people.attend()
            now_ns = time.monotonic_ns()
            party.watch.poll(now_ns)
            if party.record is not None:
                report = partial(self._violated, party.record.robot)
                follow(party.record, party.system, party.people, now_ns, report)
            if party.watch.launcher_gone:
                self._lost(party, now_ns)
        self._progress(self._elapsed_s(), "")

    def _note_stop(self, party: Party) -> None:
        """A stop of the driver that nobody caused is no violation; its reason may explain others."""
        stops, link = party.system.judge.stops, party.system.link
        if stops == party.stops or link is None or link.view.driver is None:
            return
        party.stops = stops
        line = f"{party.system.robot.name} stopped by itself: {link.view.driver.reason}"
        if party.record is not None:
            party.record.notes.append(f"{line} at {self._elapsed_s():.1f} s")
        self._progress(self._elapsed_s(), line)

    def _lost(self, party: Party, now_ns: int) -> None:
        """A launcher has ended by itself: people start it again."""
        lines = party.system.logs[-1].read_text(errors="replace").splitlines()
        self._violated(party.system.robot.name, now_ns, Invariant.CHILDREN, f"the launcher has ended: {lines[-3:]}")
        party.ending = True
        party.system.end(self.wait)
        self._start(party)

    def _inject(self, planned: Planned) -> None:
        party, fault = self.parties[planned.robot], FAULTS[planned.fault]
        self.wait(lambda: self._moves(party), MOVING_S)
        self.wait(lambda: False, self._draw.uniform(0.0, 0.2))
        now_ns = time.monotonic_ns()
        record = FaultRecord(planned.fault, fault.row, planned.robot, self._elapsed_s(), now_ns, self._moves(party))
        party.record = record
        scene = Scene(party.system, party.people, record, self._draw, self.wait, self.restart, self._startup_s)
        self._progress(self._elapsed_s(), f"{planned.robot}: {planned.fault}{'' if record.moving else ' (at rest)'}")
        try:
            fault.inject(scene)
        except (LookupError, OSError) as error:
            self.result.failed_faults.append(f"{planned.fault}: {error}")
        else:
            self.result.records.append(record)

    def _heard(self, party: Party) -> bool:
        return party.system.heard(time.monotonic_ns())

    def _moves(self, party: Party) -> bool:
        judge = party.system.judge
        return judge.permitted and time.monotonic_ns() - judge.moved_ns < MOVING_NS

    def _violated(self, robot: str, now_ns: int, invariant: Invariant, detail: str) -> None:
        record = self.parties[robot].record
        at_s = now_ns / 1e9 - self._began_s
        stall_s = self._stalls.worst_since(now_ns / 1e9 - STALL_WINDOW_S)
        fault = f"{record.name} at {record.at_s:.1f} s" if record is not None else ""
        violation = Violation(at_s, robot, invariant, detail, fault, stall_s)
        self.result.violations.append(violation)
        excuse = " (the machine stalled)" if violation.excused else ""
        self._progress(at_s, f"VIOLATION{excuse} {robot}: {invariant.name}: {detail}; after {fault or 'no fault'}")

    def _elapsed_s(self) -> float:
        return time.monotonic() - self._began_s
