"""An executive that only drives, armed by a person; commands a speed at 10 Hz. Arguments: endpoint, speed.

SIGUSR1 hangs it with the interpreter's lock held, as a native library may; the threads of its bus session live on.
"""

import re
import signal
import sys

from tailor.runtime.bus.opening import open_client
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.messages import ArmRequest, VelocityCommand


def hang(*_):
    re.match("(a+)+$", "a" * 60 + "b")  # takes years


def main(endpoint, speed):
    stop = stop_on_signals()
    signal.signal(signal.SIGUSR1, hang)
    codec.prime()
    with open_client(endpoint, role="executive") as session, open_client(endpoint, role="people") as person:
        commands, arming = session.publisher("cmd_vel", "agilo"), person.publisher("arm_request", "agilo")
        inbox, armed = session.inbox(["driver"], "agilo"), False
        loop = Loop(100_000_000, MonotonicClock())
        while not stop.requested:
            period = loop.wait_for_next_period()
            if inbox.drain(period.now_ns) and not armed:
                arming.publish(ArmRequest(True, False, session.sender, 0))
                armed = True
            commands.publish(VelocityCommand(period.now_ns, float(speed), 0.0))


if __name__ == "__main__":
    main(*sys.argv[1:])
