"""Drives a simulated porter over the bus by both outlets, then by the gripper's alone: its guard must stop both.

Run by test_new_robot.py in an environment that has the package; prints the driver's mode at the end.
"""

import sys
import time

from tailor.runtime.bus.opening import open_router
from tailor.runtime.processes.child import Child
from tailor.schemas.messages import ArmRequest

ROBOT, PERIOD_S = "porter-3", 0.1
SPEED_MPS, WIDTH_M, OPEN_M = 0.4, 0.04, 0.12


def main(endpoint: str) -> None:
    """Raises AssertionError if the robot does not do as its commands say."""
    from porter.messages import GripCommand, RailCommand

    with open_router(endpoint) as session:
        sim = Child("sim", [sys.executable, "-P", "-m", "tailor.tools.main", "sim", ROBOT, "--connect", endpoint])
        try:
            states, truth = (session.inbox([name], ROBOT) for name in ("driver", "porter_exact"))
            newest(states, 20.0)
            session.publisher("arm_request", ROBOT).publish(ArmRequest(True, False, session.sender, 0))
            rail, grip = (session.publisher(name, ROBOT) for name in ("porter_rail", "porter_grip"))
            for _ in range(10):
                rail.publish(RailCommand(0, SPEED_MPS))
                grip.publish(GripCommand(0, WIDTH_M))
                time.sleep(PERIOD_S)
            driven = newest(truth)
            assert newest(states).mode == "armed"
            assert driven.rate > 0.3, f"the rail's outlet does not drive: {driven}"
            assert driven.width < 0.10, f"the gripper's outlet does not drive: {driven}"
            for _ in range(15):  # the rail's outlet is silent
                grip.publish(GripCommand(0, WIDTH_M))
                time.sleep(PERIOD_S)
            stopped = newest(truth)
            assert stopped.rate == 0.0, f"the cart still rolls: {stopped}"
            for _ in range(10):
                grip.publish(GripCommand(0, OPEN_M))
                time.sleep(PERIOD_S)
            assert newest(truth).width == stopped.width, "the gripper obeys its outlet, though its guard has stopped"
            print(newest(states).mode)
        finally:
            sim.kill()


def newest(inbox, limit_s: float = 2.0):
    """The newest message of an inbox."""
    until = time.monotonic() + limit_s
    while time.monotonic() < until:
        samples = inbox.drain()
        if samples:
            return samples[-1].message
        time.sleep(0.02)
    raise AssertionError(f"no message within {limit_s} s")


if __name__ == "__main__":
    main(sys.argv[1])
