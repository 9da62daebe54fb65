"""What a fault can do: the system that it hits, its people, time, and a record of what came of it."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from tempfile import TemporaryDirectory, TemporaryFile

from tailor.runtime.processes.child import Child
from tailor.tools.soak.systems.people import People
from tailor.tools.soak.systems.sessions import stranger_environment
from tailor.tools.soak.systems.system import System, Wait

BURN = "while True: pass"
INTRUDER_S = 15.0
BACK_S = 3.0
BURNERS = 4


@dataclass(slots=True)
class FaultRecord:
    """A fault and its consequences; seconds since the fault, None: not seen."""

    name: str
    row: int  # of the table of faults
    robot: str
    at_s: float  # since the start of the soak
    at_ns: int
    moving: bool  # when it came
    body_ends: bool = False  # with its simulator: nothing remains to come to rest
    zero_s: float | None = None
    rest_s: float | None = None
    back_s: float | None = None
    again_s: float | None = None  # from people's arming to motion
    back_when: Callable[[], bool] | None = None
    back_limit_s: float = 0.0
    back_late: bool = False
    sent: int = 0
    refused: bool = False
    notes: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Scene:
    """Given to the function that injects a fault."""

    system: System
    people: People
    record: FaultRecord
    draw: random.Random
    wait: Wait
    restart: Callable[[System, signal.Signals], None]
    startup_s: float

    def run_for(self, seconds: float) -> None:
        """Let time pass."""
        self.wait(lambda: False, seconds)

    def expect_back(self, condition: Callable[[], bool]) -> None:
        """The system is complete again, is heard, and the condition holds, within BACK_S and a start-up."""
        self.record.back_when, self.record.back_limit_s = condition, BACK_S + self.startup_s

    def begin(self) -> None:
        """The fault itself comes now, after what was prepared for it."""
        self.record.at_ns = self.now_ns()

    def heard_ids(self) -> dict[str, str]:
        """Ids by which the present executive and simulator differ from earlier ones; empty without a connection."""
        link = self.system.link
        if link is None or link.view.driver is None:
            return {}
        return {"executive": link.view.sender, "sim": str(link.view.driver.epoch)}

    def pid(self, name: str) -> int:
        """Process id of a process that runs; waits for it if it is being restarted.

        Raises:
          LookupError: It does not run.
        """
        self.wait(lambda: self.system.pid(name) is not None, 5.0)
        pid = self.system.pid(name)
        if pid is None:
            raise LookupError(f"{name} does not run")
        return pid

    def intrude(self, kind: str) -> None:
        """Run an intruder of this kind without credentials; if it is refused, another one with those of an observer."""
        with TemporaryDirectory() as empty:
            refused = self._run_intruder(kind, "", {**os.environ, **stranger_environment(empty)})
        if refused:
            self.record.refused = True
            self._run_intruder(kind, "observer", dict(os.environ))

    def _run_intruder(self, kind: str, known: str, environment: dict[str, str]) -> bool:
        """Whether its session was refused.

        Raises:
          ChildProcessError: It has failed, so that nothing was tried.
        """
        words = (self.system.endpoint, self.system.robot.name, kind, str(self.draw.randrange(10_000)), known)
        argv = [sys.executable, "-P", "-m", "tailor.tools.soak.faults.intrude", *words]
        with TemporaryFile("w+") as output:
            with subprocess.Popen(argv, stdout=output, stderr=output, text=True, env=environment) as process:
                self.wait(lambda: process.poll() is not None, INTRUDER_S)
                process.kill()
            output.seek(0)
            printed = output.read()
        try:
            result = json.loads(printed)
        except ValueError:
            raise ChildProcessError(f"the intruder failed: {printed.strip()[-200:] or 'no end'}") from None
        self.record.sent += result["sent"]
        return bool(result["refused"])

    @contextmanager
    def burners(self) -> Iterator[None]:
        """CPU burners."""
        children = [Child("burner", [sys.executable, "-c", BURN]) for _ in range(BURNERS)]
        try:
            yield
        finally:
            for child in children:
                child.kill()

    def now_ns(self) -> int:
        """Monotonic time."""
        return time.monotonic_ns()
