"""Delay from percept to command that `tailor driver` adds to a robot with plain topics.

A stand-in robot publishes odometry, and a stand-in executive answers each with a command of its own speed at once; so
the delay is that of bus and driver, without the executive's period. Without a driver both are on one bus.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.runtime.bus.inbox import Source
from tailor.runtime.bus.opening import open_client, open_router
from tailor.runtime.bus.publisher import Publisher
from tailor.runtime.bus.session import Session
from tailor.runtime.processes.child import Child, stopped_in_order, tailor
from tailor.schemas import codec
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ArmRequest, DriverState, Odometry, VelocityCommand
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import from_bytes, ros_type
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.launch.hosting import free_endpoint

ROBOT = "agilo"
POLL_S = 0.0005
PERIOD_S = 0.05  # between two percepts
PATIENCE_S = 30.0  # until the driver is armed
STEP_MPS, SPEEDS = 0.001, 500  # the speeds number the percepts, round and round
TWIST = "geometry_msgs/msg/Twist"


@dataclass(frozen=True, slots=True)
class Ends:
    """Both ends of the way.

    Attributes:
      odometry, received: The robot publishes odometry and receives commands.
      executive, commands: Session and publisher of the executive.
      speed: linear.x in the bytes of a received command.
    """

    odometry: Publisher
    received: Source
    executive: Session
    commands: Publisher
    speed: Callable[[bytes], float]


def run(console: Console, quick: bool) -> None:
    """Print one row for each way.

    Raises:
      NoMeasurement: The driver is not armed, or hardly a percept was answered.
    """
    percepts = 100 if quick else 400
    codec.prime()
    table = Table("way", "percepts", "answered", "ms", title="percept to command, without the executive's period")
    table.caption = "p50 / p99 / max"
    with one_bus() as ends:
        table.add_row("on one bus", *row(delays_ms(ends, percepts), percepts))
    with through_driver() as ends:
        table.add_row("through tailor driver", *row(delays_ms(ends, percepts), percepts))
    console.print(table)


def row(found_ms: list[float], percepts: int) -> list[str]:
    """Cells of one way; raises NoMeasurement if fewer than half of the percepts were answered."""
    if 2 * len(found_ms) < percepts:
        raise NoMeasurement(f"{len(found_ms)} of {percepts} percepts were answered")
    p50, p99 = np.percentile(found_ms, [50, 99])
    return [str(percepts), str(len(found_ms)), f"{p50:.1f} / {p99:.1f} / {max(found_ms):.1f}"]


@contextmanager
def one_bus() -> Iterator[Ends]:
    """Robot and executive without a driver."""
    endpoint = free_endpoint()
    with open_router(endpoint), open_client(endpoint) as robot, open_client(endpoint) as executive:
        [received] = robot.raw_sources("cmd_vel", ROBOT)
        yield Ends(robot.publisher("odom", ROBOT), received, executive, executive.publisher("cmd_vel", ROBOT), _stamped)


@contextmanager
def through_driver() -> Iterator[Ends]:
    """Robot and executive with an armed `tailor driver` between them."""
    ours, robots = free_endpoint(), free_endpoint()
    with tempfile.TemporaryDirectory() as folder, open_router(ours), open_router(robots):
        file = Path(folder, "robot.toml")
        file.write_text(
            f'robot = "{ROBOT}"\ncommand = "twist"\n[bus]\nconnect = "{robots}"\n'
            '[topics]\npose = ""\n[pose]\nstart = [0.0, 0.0, 0.0]\n',
            encoding="utf-8",
        )
        with (
            tempfile.TemporaryFile("w") as log,
            stopped_in_order([Child("driver", tailor("driver", str(file), "--connect", ours), log)]),
            open_client(robots) as robot,
            open_client(ours) as executive,
        ):
            odometry = robot.plain_publisher("odom", f"application/cdr;{ros_type(Odometry)}")
            received, commands = robot.plain_source("cmd_vel"), executive.publisher("cmd_vel", ROBOT)
            ends = Ends(odometry, received, executive, commands, _plain)
            _arm(ends)
            yield ends


def _arm(ends: Ends) -> None:
    """Wait until the driver is ready, and arm it."""
    states = ends.executive.inbox(["driver"], ROBOT)
    requests = ends.executive.publisher("arm_request", ROBOT)
    until_s = time.monotonic() + PATIENCE_S
    while time.monotonic() < until_s:
        ends.odometry.publish_encoded(codec.encode(_odometry()))
        ends.commands.publish(VelocityCommand(time.time_ns(), 0.0, 0.0))
        time.sleep(PERIOD_S)
        modes = [each.message.mode for each in states.drain() if isinstance(each.message, DriverState)]
        if "armed" in modes:
            return
        requests.publish(ArmRequest(True, False, ends.executive.sender, 0))
    raise NoMeasurement(f"the driver is not armed within {PATIENCE_S:g} s")


def delays_ms(ends: Ends, percepts: int) -> list[float]:
    """Delays of the percepts that were answered before the next one."""
    inbox, found = ends.executive.inbox(["odom"], ROBOT), list[float]()
    for number in range(percepts):
        speed_mps, answered = STEP_MPS * (1 + number % SPEEDS), len(found)
        began_s = time.monotonic()
        ends.odometry.publish_encoded(codec.encode(_odometry()))
        while time.monotonic() < began_s + PERIOD_S:
            if inbox.drain():
                ends.commands.publish(VelocityCommand(time.time_ns(), speed_mps, 0.0))
            came = [each for each in _speeds(ends) if abs(each - speed_mps) < STEP_MPS / 2]
            if came and len(found) == answered:
                found.append((time.monotonic() - began_s) * 1e3)
            time.sleep(POLL_S)
    return found


def _speeds(ends: Ends) -> Iterator[float]:
    """Speeds that the robot has received since the last call."""
    while (raw := ends.received.receive()) is not None:
        if not isinstance(raw, Rejected):
            yield ends.speed(raw.payload)


def _stamped(payload: bytes) -> float:
    message = codec.decode(TOPICS["cmd_vel"], payload)
    return message.v if isinstance(message, VelocityCommand) else 0.0


def _plain(payload: bytes) -> float:
    return float(from_bytes(payload, TWIST)[0].linear.x)


def _odometry() -> Odometry:
    return Odometry(time.time_ns(), 0.0, 0.0, 0.0, 0.0, 0.0)
