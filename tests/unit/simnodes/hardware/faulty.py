"""Hardware that fails on request, and a bus that is a list."""

import threading
from collections import Counter, deque
from dataclasses import replace

from tailor.schemas.codec import decode
from tailor.schemas.messages import Odometry
from tailor.schemas.topics import TOPICS
from tailor.simnodes.hardware.interface import Hardware

PATIENT_S = 30.0  # of a call: no stall of the machine is taken for one of the hardware
STALLED_S = 0.5
AT_REST = Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Faulty(Hardware):
    """Notes what is called; `raises` names the methods that raise `error`, `stalls` those that wait for `released`."""

    robot = "agilo"
    write_hz = 200.0

    def __init__(self, impatient=()):
        """Calls may take `PATIENT_S`, those named in `impatient` only `STALLED_S`."""
        limits = [STALLED_S if name in impatient else PATIENT_S for name in ("open", "read", "write")]
        self.open_s, self.read_s, self.write_s = limits
        self.raises, self.stalls, self.calls, self.written = set(), set(), Counter(), []
        self.released = threading.Event()
        self.error: type[BaseException] = OSError
        self.silent, self.odometry, self.order, self.freed = False, {}, [], False

    def _called(self, name):
        self.calls[name] += 1
        self.order.append(name)
        if name in self.raises:
            raise self.error(f"no {name}")
        if name in self.stalls:
            self.freed = self.released.wait(5)

    def open(self):
        self._called("open")

    def read(self):
        threading.Event().wait(0.01)
        self._called("read")
        return {} if self.silent else self._measured()

    def _measured(self):
        """A new message each time."""
        if isinstance(self.odometry, list):
            return self.odometry
        return {name: replace(each) for name, each in (self.odometry or {"odom": AT_REST}).items()}

    def write(self, values):
        self.written.append(values)
        self._called("write")

    def close(self):
        self._called("close")
        if "close frees" in self.stalls:
            self.released.set()


class Bus:
    """Session, inbox and publishers in one."""

    def __init__(self):
        self.waiting, self.rejected, self.published = deque(), Counter(), {}

    def inbox(self, names, robot):
        return self

    def drain(self, now_ns):
        return tuple(self.waiting.popleft() for _ in range(len(self.waiting)))

    def publisher(self, name, robot):
        return Published(TOPICS[name], self.published.setdefault(name, []))


class Published:
    def __init__(self, topic, messages):
        self.publish = messages.append
        self.publish_encoded = lambda payload: messages.append(decode(topic, payload))
