"""A ROS-like base in its own process that knows nothing of Tailor: own dynamics, own CDR, no attachments.

It takes a Twist or a TwistStamped, publishes odometry at 50 Hz or at every `odom_every`-th step of that, and a pose of
its localiser while it moves. As most bases, it stops by itself 0.5 s after the last command. Argument: JSON of
`DEFAULTS`; each change of speed goes to `trace`. SIGUSR1 freezes its odometry: the last message is published again and
again.
"""

import json
import math
import random
import signal
import struct
import sys
import time

import zenoh

DEFAULTS = {
    "endpoint": "", "trace": "", "command": "twist", "cmd_vel": "cmd_vel", "odom": "odom", "pose": "amcl_pose",
    "start": [0.0, 0.0, 0.0], "odom_frame": "odom", "odom_every": 1, "odom_stamps": True,
}  # fmt: skip
PERIOD_S, TIMEOUT_S, DEAD_S = 0.02, 0.5, 0.04
FASTER, SLOWER, TURN = 0.5, 0.65, 1.75  # m/s², m/s², rad/s²


class Writer:
    """CDR, little-endian; numbers are aligned to their size."""

    def __init__(self):
        self.data = bytearray()

    def number(self, layout, *values):
        size = struct.calcsize(layout)
        for value in values:
            self.data += b"\0" * (-len(self.data) % size) + struct.pack("<" + layout, value)

    def text(self, text):
        self.number("I", len(text) + 1)
        self.data += text.encode() + b"\0"

    def header(self, frame, stamped=True):
        seconds, rest = divmod(time.time_ns() * stamped, 10**9)
        self.number("i", seconds)
        self.number("I", rest)
        self.text(frame)

    def pose(self, x, y, phi, variances=()):
        self.number("d", x, y, 0.0, 0.0, 0.0, math.sin(phi / 2), math.cos(phi / 2))
        covariance = [0.0] * 36
        covariance[0], covariance[7], covariance[35] = variances or (0.0, 0.0, 0.0)
        self.number("d", *covariance)

    def bytes(self):
        return b"\0\1\0\0" + bytes(self.data)


def odometry(pose, v, omega, frame, stamped):
    writer = Writer()
    writer.header(frame, stamped)
    writer.text("base_link")
    writer.pose(*pose)
    writer.number("d", v, 0.0, 0.0, 0.0, 0.0, omega, *([0.0] * 36))
    return writer.bytes()


def located(pose, variances):
    writer = Writer()
    writer.header("map")
    writer.pose(*pose, variances)
    return writer.bytes()


def velocity(data, stamped):
    """linear.x and angular.z of the bytes."""
    at = 4
    if stamped:
        (length,) = struct.unpack_from("<I", data, 12)
        at = 4 + -(-(12 + length) // 8) * 8
    values = struct.unpack_from("<6d", data, at)
    return values[0], values[5]


def moved(pose, v, omega):
    x, y, phi = pose
    middle = phi + omega * PERIOD_S / 2
    return x + v * PERIOD_S * math.cos(middle), y + v * PERIOD_S * math.sin(middle), phi + omega * PERIOD_S


def ramped(v, wanted, rate):
    return v + max(-rate * PERIOD_S, min(rate * PERIOD_S, wanted - v))


def main(options):
    robot = DEFAULTS | json.loads(options)
    config = zenoh.Config.from_json5(json.dumps({"mode": "client", "connect": {"endpoints": [robot["endpoint"]]}}))
    frozen: list[bool] = []
    signal.signal(signal.SIGUSR1, lambda *_: frozen.append(True))
    noise, stamped = random.Random(1), robot["command"] == "twist_stamped"
    with zenoh.open(config) as session, open(robot["trace"], "w", buffering=1) as trace:
        commands = session.declare_subscriber(robot["cmd_vel"], zenoh.handlers.RingChannel(8))
        truth, odom, v, omega = tuple(robot["start"]), (0.0, 0.0, 0.0), 0.0, 0.0
        waiting, wanted, heard_s, written = [], (0.0, 0.0), -math.inf, None
        step, began_s, seen_at, message = 0, time.monotonic(), None, b""
        while True:
            step += 1
            time.sleep(max(0.0, began_s + step * PERIOD_S - time.monotonic()))
            now_s = time.monotonic()
            while (sample := commands.try_recv()) is not None:
                waiting.append((now_s + DEAD_S, velocity(sample.payload.to_bytes(), stamped)))
            while waiting and waiting[0][0] <= now_s:
                heard_s, wanted = waiting.pop(0)
            if now_s - heard_s > TIMEOUT_S:
                wanted = (0.0, 0.0)
            v = ramped(v, wanted[0], FASTER if abs(wanted[0]) > abs(v) and wanted[0] * v >= 0 else SLOWER)
            omega = ramped(omega, wanted[1], TURN)
            truth, odom = moved(truth, v, omega), moved(odom, v * 1.01, omega * 0.99)  # odometry drifts
            if (v, omega) != written:
                written = (v, omega)
                trace.write(f"{time.monotonic_ns()} {v!r} {omega!r} {wanted[0]!r}\n")
            message = message if frozen else odometry(odom, v, omega, robot["odom_frame"], robot["odom_stamps"])
            if step % robot["odom_every"] == 0:
                session.put(robot["odom"], message)
            if not robot["pose"] or step % 10:
                continue
            if (
                seen_at is None
                or math.dist(truth[:2], seen_at[:2]) > 0.05
                or abs(truth[2] - seen_at[2]) > 0.05
                or step < 200
            ):
                seen_at = truth
                seen = tuple(value + noise.gauss(0.0, 0.01) for value in truth)
                session.put(robot["pose"], located(seen, (1e-4, 1e-4, 1e-4)))


if __name__ == "__main__":
    main(sys.argv[1])
