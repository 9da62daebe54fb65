"""One launched system under soak: its processes, and people's session on its bus."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path

from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.errors import UsageError
from tailor.tools.launch.hosting import free_endpoint
from tailor.tools.soak.judging.motion import MotionJudge, Report
from tailor.tools.soak.judging.robots import Robot
from tailor.tools.soak.systems import processes
from tailor.tools.soak.systems.sessions import open_people
from tailor.tools.soak.systems.view import Totals, View

CHILDREN = ("gateway", "record", "sim", "executive")
FRESH_NS = 1_000_000_000
END_S = 5.0  # faults.md, row 11
CALL_S = 1.0
OPEN_S = 0.2  # of one try to open a session


Wait = Callable[[Callable[[], bool], float], bool]  # for a condition, at most so many seconds


@dataclass(frozen=True, slots=True)
class End:
    """How a system ended."""

    code: int | None  # of the launcher; None: it had to be killed
    took_s: float
    left: list[int]  # processes left behind, killed by now


@dataclass(frozen=True, slots=True)
class Link:
    """People's session on the bus of one start; a new publisher would lose its first message."""

    session: Session
    view: View
    arming: Publisher
    estop: Publisher


class System:
    """Started as people do: `tailor up`, with a recorder.

    Attributes:
      robot: The robot.
      judge: Judge of its motion, over all starts.
      totals: Counts over all starts.
      endpoint: Endpoint of its bus; another one for each start.
      scenario: Name of its scenario.
      link: People's session on its bus; None without a connection.
      began_ns: Time of the present start.
      recordings, logs: Files of all starts.
    """

    def __init__(self, robot: Robot, folder: Path, report: Report) -> None:
        """Nothing runs yet; recordings and logs go into `folder`."""
        self.robot, self.judge, self.totals = robot, MotionJudge(robot, report), Totals()
        self.endpoint = self.scenario = ""
        self.link: Link | None = None
        self.began_ns = 0
        self.recordings: list[Path] = []
        self.logs: list[Path] = []
        self._folder = folder
        self._stack = ExitStack()
        self._up: Child | None = None
        self._pids: set[int] = set()  # of all processes of this start

    def start(self, scenario: str, seed: int) -> None:
        """Start it; `poll` connects to it as soon as its bus is there."""
        name = f"{self.robot.name}-{len(self.recordings):02d}"
        self.recordings.append(self._folder / f"{name}.mcap")
        self.logs.append(self._folder / f"{name}.log")
        self.endpoint, self.scenario = free_endpoint(), scenario
        words = ("--scenario", scenario, "--seed", str(seed), "--connect", self.endpoint)
        argv = tailor("up", self.robot.domain, *words, "--no-scene", "--record", str(self.recordings[-1]))
        self.began_ns = time.monotonic_ns()
        self.judge.launched(self.began_ns)
        with self.logs[-1].open("w") as output:
            self._up = Child("up", argv, output)

    def poll(self) -> None:
        """Take messages and check for overdue stops."""
        if self._up is not None and self.link is None:
            self._connect()
        if self.link is not None:
            self.link.view.poll()
            self.judge.check(time.monotonic_ns())

    def pids(self) -> dict[str, list[int]]:
        """Process ids of launcher and children, by name."""
        if self._up is None or self._up.exit_code() is not None:
            return {}
        found = {"up": [self._up.pid], **processes.children(self._up.pid)}
        self._pids.update(pid for pids in found.values() for pid in pids)
        return found

    def pid(self, name: str) -> int | None:
        """Process id of one of them; None while it does not run."""
        found = self.pids().get(name, [])
        return found[0] if found else None

    def heard(self, now_ns: int) -> bool:
        """Whether executive and driver have been heard within the last second."""
        link = self.link
        return link is not None and min(link.view.status_ns, link.view.driver_ns) > now_ns - FRESH_NS

    def call(self, service: str, text: str) -> tuple[bool, str]:
        """People's request to a service; (False, reason) without a connection."""
        return self.link.session.call(service, text, CALL_S) if self.link is not None else (False, "no connection")

    def complete(self) -> bool:
        """Whether the launcher runs, with each child once."""
        found = self.pids()
        return all(len(found.get(name, [])) == 1 for name in CHILDREN)

    def end(self, wait: Wait, sign: signal.Signals = signal.SIGINT) -> End:
        """End its launcher with a signal, by default Ctrl-C's, and by force if it does not obey.

        Args:
          wait: Waits for a condition for so many seconds, while other systems are looked after.
          sign: Signal for the launcher.
        """
        up = self._up
        if up is None:
            return End(0, 0.0, [])
        self.pids()
        self._up = None
        began_s = time.monotonic()
        send_signal(up.pid, sign)
        wait(lambda: up.exit_code() is not None, END_S)
        code, took_s = up.exit_code(), time.monotonic() - began_s
        up.kill()
        self._stack.close()
        self.link = None
        wait(lambda: not self._left(), END_S)
        left = self._left()
        for pid in left:
            send_signal(pid, signal.SIGKILL)
        self._pids.clear()
        return End(code, took_s, left)

    def _connect(self) -> None:
        with suppress(UsageError):
            session = self._stack.enter_context(open_people(self.endpoint, OPEN_S))
            view = View(session, self.robot, self.judge, self.totals)
            arming, estop = session.publisher("arm_request", self.robot.name), session.publisher("estop", "")
            self.link = Link(session, view, arming, estop)

    def _left(self) -> list[int]:
        return sorted({*filter(processes.is_alive, self._pids), *processes.naming(self.endpoint)})


def send_signal(pid: int, sign: signal.Signals) -> None:
    """Send a signal; a process that has ended is no error."""
    with suppress(ProcessLookupError):
        os.kill(pid, sign)
