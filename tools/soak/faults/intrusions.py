"""What intruders do for a few seconds; each returns how much it sent."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from tailor.runtime.bus.attachment import Origin, unpack
from tailor.schemas.codec import encode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ArmRequest, DriverState, EStop, ExecStatus, Message
from tailor.schemas.topics import TOPICS, key_of
from tailor.schemas.typesystem import ros_type
from tailor.tools.soak.faults.intruder import Intruder
from tailor.tools.soak.systems.strangers import stranger_id

SECONDS = 3.0
RATE_HZ = 50.0
FLOOD = 100_000  # messages at most
BIG_BYTES = 1_000_000
ODD = (float("nan"), float("inf"), float("-inf"), 5e-324, 1e308, -0.0, 2.0, -2.0)
GOALS = ("(", "(and)", "(no such)", "(at way1 way1 way1)", "\0", "(" * 5000, "(and " + "(at way1) " * 3000 + ")")


def _paced(rate_hz: float = RATE_HZ) -> Iterator[None]:
    ends = time.monotonic() + SECONDS
    while time.monotonic() < ends:
        yield
        time.sleep(1.0 / rate_hz)


def _junk(who: Intruder) -> int:
    """Random bytes on every key, signed and unsigned."""
    players = [
        who.session.player(key_of(name, who.robot), ros_type(topic.type))
        for name, topic in TOPICS.items()
        if name != "clock"
    ]
    count = 0
    for number, _ in enumerate(_paced(20.0)):
        for player in players:
            origin = Origin(number, 0, who.draw.choice(["", who.session.sender]))
            player.put_raw(who.draw.randbytes(who.draw.randrange(300)), origin)
            count += 1
    return count


def _truncated(who: Intruder) -> int:
    """Commands of the executive, cut or with one byte changed, in its own name and number."""
    player = who.session.player(key_of(who.command(), who.robot), "")
    count = 0
    for _ in _paced():
        for raw in who.heard[-1:]:
            data = bytearray(raw.payload)
            data[who.draw.randrange(len(data))] ^= 1 << who.draw.randrange(8)
            player.put_raw(bytes(data[: who.draw.randrange(len(data))]), who.victim())
            count += 1
    return count


def _replayed(who: Intruder) -> int:
    """What was heard, once more and again."""
    player = who.session.player(key_of(who.command(), who.robot), "")
    count = 0
    for _ in _paced():
        for raw in who.heard:
            origin = unpack(raw.attachment)
            if not isinstance(origin, Rejected):
                player.put_raw(raw.payload, origin)
                count += 1
    return count


def _odd_values(who: Intruder) -> int:
    """Not finite, huge and beyond the limits, in the intruder's name and in the executive's."""
    publisher, victim = who.publisher(who.command()), who.victim()
    count = 0
    for number, _ in enumerate(_paced()):
        message = who.velocities(who.draw.choice(ODD), who.draw.choice(ODD))
        publisher.publish(message)
        publisher.put_raw(encode(message), Origin(victim.sequence + 10 + number, 0, victim.sender))
        count += 2
    return count


def _foreign(who: Intruder) -> int:
    """Legal commands in the intruder's own name."""
    publisher = who.publisher(who.command())
    return sum(1 for _ in _paced() if publisher.publish(who.velocities(0.5, 0.5)))


def _lockout(who: Intruder) -> int:
    """A legal command with the greatest number, in the executive's name."""
    victim = who.victim()
    publisher = who.publisher(who.command())
    data = encode(who.velocities(0.0, 0.0))
    for _ in _paced(10.0):
        publisher.put_raw(data, Origin(2**63 - 1, 0, victim.sender))
    return int(SECONDS * 10)


def _states(who: Intruder) -> int:
    """Another driver's state, another executive's status."""
    driver, status = who.publisher("driver"), who.publisher("status")
    count = 0
    for _ in _paced():
        mode = who.draw.choice(["armed", "disarmed", "stopped", "estopped"])
        driver.publish(DriverState(time.time_ns(), mode, "", "", who.draw.getrandbits(60), stranger_id(3), 1))
        status.publish(_status(who))
        count += 2
    return count


def _status(who: Intruder) -> ExecStatus:
    mode, result = who.draw.choice(["READY", "FAULT", "EXECUTING"]), who.draw.choice(["", "achieved", "failed"])
    return ExecStatus(time.time_ns(), 1, mode, "", "", "", result, "", 0, 0.0, 0.0, sender=who.session.sender)


def _oversize(who: Intruder) -> int:
    """A megabyte on every key."""
    payload, count = bytes(BIG_BYTES), 0
    for name, topic in TOPICS.items():
        who.session.player(key_of(name, who.robot), ros_type(topic.type)).put_raw(payload, Origin(1, 0, ""))
        count += 1
    return count


def _senders(who: Intruder) -> int:
    """A hundred senders on one key."""
    publisher = who.publisher("currents")
    for number in range(100):
        publisher.put_raw(b"\0", Origin(1, 0, stranger_id(1000 + number)))
    return 100


def _services(who: Intruder) -> int:
    """Requests that no service can fulfil."""
    keys = ("exec/goal", *(f"{who.robot}/sim/{name}" for name in ("reset", "place", "step")))
    texts = (*GOALS, "[" * 5000, '{"seed": -1}', '{"x": 1e999}', "{", '{"start": {"nose": 1}}')
    count = 0
    for _ in _paced(20.0):
        who.session.call(who.draw.choice(keys), who.draw.choice(texts), 0.5)
        count += 1
    return count


def _arming(who: Intruder) -> int:
    """Requests to arm for the intruder itself, and its commands; only where they have no right to come through."""
    if not who.known:
        return 0  # an open bus takes everybody for people
    arming, publisher = who.publisher("arm_request"), who.publisher(who.command())
    for _ in _paced():
        arming.publish(ArmRequest(True, True, who.session.sender, 0))
        publisher.publish(who.velocities(0.5, 0.5))
    return int(2 * SECONDS * RATE_HZ)


def _flood(topic: str, message: Message) -> Callable[[Intruder], int]:
    def flood(who: Intruder) -> int:
        publisher = who.publisher(who.command() if topic == "command" else topic)
        ends, count = time.monotonic() + SECONDS, 0
        while count < FLOOD and time.monotonic() < ends:
            publisher.publish(who.velocities(0.1, 0.1) if topic == "command" else message)
            count += 1
        return count

    return flood


KINDS: dict[str, Callable[[Intruder], int]] = {
    "junk": _junk,
    "truncated": _truncated,
    "replayed": _replayed,
    "odd values": _odd_values,
    "foreign": _foreign,
    "lockout": _lockout,
    "arming": _arming,
    "states": _states,
    "oversize": _oversize,
    "senders": _senders,
    "services": _services,
    "flood of commands": _flood("command", EStop(False)),
    "flood of e-stop's key": _flood("estop", EStop(False)),
    "flood of arming's key": _flood("arm_request", ArmRequest(False, False, "", 1)),
    "flood of driver states": _flood("driver", DriverState(0, "armed", "", "", 1, "", 0)),
}
