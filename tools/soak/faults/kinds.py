"""Faults that a soak injects, and what each entitles the judge to expect; rows of the project's table of faults.

Not among them: what needs a namespace or a proxy between executive and driver. A frozen launcher, whose process is the
router, cuts everybody off from everybody instead.
"""

from __future__ import annotations

import json
import resource
import signal
import socket
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import EStop
from tailor.tools.soak.faults.intruder import KINDS
from tailor.tools.soak.faults.scene import Scene
from tailor.tools.soak.systems.sessions import open_people
from tailor.tools.soak.systems.system import send_signal

GUARD_S = 0.3  # the guard's timeout
ESTOP_S = 0.2
SILENT = 110
SILENT_S = 2.0
BURN_S = 10.0
FULL_S = 5.0


@dataclass(frozen=True, slots=True)
class Fault:
    """One kind of fault."""

    row: int
    inject: Callable[[Scene], None]


def _kill(scene: Scene, names: tuple[str, ...]) -> None:
    """kill -9; the driver sees the executive's end by its silence, its own by nothing."""
    before = {name: scene.pid(name) for name in names}
    heard = scene.heard_ids()
    if "sim" in names:
        scene.record.body_ends = True
        scene.system.judge.revoke(scene.now_ns())
    elif "executive" in names:
        scene.system.judge.revoke(scene.now_ns(), GUARD_S)
    for pid in before.values():
        send_signal(pid, signal.SIGKILL)
    scene.expect_back(lambda: all(scene.heard_ids().get(name) not in (None, heard.get(name)) for name in names))


def _kill_recorder(scene: Scene) -> None:
    """Motion goes on; a recorder that nobody starts again is people's affair: they restart the system."""
    before = scene.pid("record")
    send_signal(before, signal.SIGKILL)
    back = scene.wait(lambda: scene.system.pid("record") not in (None, before), 5.0)
    if not back:
        scene.record.body_ends = True
        scene.restart(scene.system, signal.SIGINT)


def _kill_gateway(scene: Scene) -> None:
    """Only sessions from elsewhere are cut off."""
    before = scene.pid("gateway")
    send_signal(before, signal.SIGKILL)
    scene.expect_back(lambda: scene.system.pid("gateway") not in (None, before))


def _freeze(scene: Scene, name: str, seconds: float) -> None:
    pid, heard = scene.pid(name), scene.heard_ids()
    dies = name == "executive" and seconds > GUARD_S
    if dies:
        scene.system.judge.revoke(scene.now_ns(), GUARD_S)
    send_signal(pid, signal.SIGSTOP)
    try:
        scene.run_for(seconds)
    finally:
        send_signal(pid, signal.SIGCONT)
    # The launcher kills an executive that is silent for a second.
    scene.expect_back(lambda: not dies or scene.heard_ids().get(name) not in (None, heard.get(name)))


def _kill_launcher(scene: Scene) -> None:
    """Its children end with it; people start the system again."""
    scene.record.body_ends = True
    scene.system.judge.revoke(scene.now_ns())
    scene.restart(scene.system, signal.SIGKILL)


def _estop(scene: Scene) -> None:
    scene.begin()
    scene.people.estop(scene.now_ns(), ESTOP_S)
    scene.run_for(1.0)


def _estop_from_new_session(scene: Scene) -> None:
    """Its time counts from before the session is opened."""
    scene.begin()
    scene.system.judge.revoke(scene.now_ns(), ESTOP_S)
    try:
        with open_people(scene.system.endpoint) as session:
            publisher = session.publisher("estop", "")
            for _ in range(10):
                publisher.publish(EStop(True))
                scene.run_for(0.05)
    except UsageError as error:
        scene.record.notes.append(f"no session for the e-stop: {error}")


def _silent_connections(scene: Scene, then: Callable[[Scene], None] | None = None) -> None:
    host, port = scene.system.endpoint.removeprefix("tcp/").split(":")
    with ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(socket.create_connection((host, int(port))))
        if then is not None:
            then(scene)
        scene.run_for(SILENT_S)


def _burn(scene: Scene, then: Callable[[Scene], None] | None = None) -> None:
    with scene.burners():
        scene.run_for(BURN_S / 2)
        if then is not None:
            then(scene)
        scene.run_for(BURN_S / 2)


def _disarm(scene: Scene) -> None:
    scene.people.disarm(scene.now_ns(), ESTOP_S)
    scene.run_for(0.5)


def _then_kill(scene: Scene, first: Callable[[Scene], None], name: str) -> None:
    first(scene)
    _kill(scene, (name,))


def _intrude(scene: Scene, kind: str) -> None:
    scene.intrude(kind)


def _disk_full(scene: Scene) -> None:
    """Of the recorder alone: its files cannot grow."""
    pid = scene.pid("record")
    size = scene.system.recordings[-1].stat().st_size
    unlimited = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, unlimited[1]))
    scene.run_for(FULL_S)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, unlimited)


def _start_values(scene: Scene) -> dict[str, float]:
    seed = scene.draw.randrange(10_000)
    return domains.seeded_scenario(scene.system.robot.domain, scene.system.scenario, seed)[1]


def _reset(scene: Scene) -> None:
    """The world starts anew while the robot moves."""
    _call(scene, "reset", {"seed": scene.draw.randrange(10_000), "start": _start_values(scene)})


def _place(scene: Scene) -> None:
    """Robot and ball are somewhere else of a sudden, at rest."""
    _call(scene, "place", _start_values(scene))


def _call(scene: Scene, service: str, argument: dict[str, object] | dict[str, float]) -> None:
    accepted, reply = scene.system.call(f"{scene.system.robot.name}/sim/{service}", json.dumps(argument))
    if not accepted:
        scene.record.notes.append(f"{service}: {reply}")


def _new_goal(scene: Scene) -> None:
    scene.system.call("exec/goal", "")


def _restart(scene: Scene) -> None:
    """Ctrl-C in motion, and another scenario."""
    scene.record.body_ends = True
    scene.restart(scene.system, signal.SIGINT)


HARMLESS: dict[str, Fault] = {
    "executive frozen 0.2 s": Fault(3, partial(_freeze, name="executive", seconds=0.2)),
    "simulator frozen 0.2 s": Fault(3, partial(_freeze, name="sim", seconds=0.2)),
    "recorder frozen 0.2 s": Fault(9, partial(_freeze, name="record", seconds=0.2)),
    "router frozen 0.2 s": Fault(13, partial(_freeze, name="up", seconds=0.2)),
    "router frozen 2 s": Fault(12, partial(_freeze, name="up", seconds=2.0)),
    "4 CPU burners": Fault(25, _burn),
    "e-stop": Fault(38, _estop),
    "e-stop of a new session": Fault(38, _estop_from_new_session),
    "e-stop beside CPU burners": Fault(38, partial(_burn, then=_estop)),
    "e-stop beside silent connections": Fault(42, partial(_silent_connections, then=_estop_from_new_session)),
    "silent connections": Fault(42, _silent_connections),
    "disarmed": Fault(41, _disarm),
    "disk full for the recorder": Fault(9, _disk_full),
    "world reset": Fault(7, _reset),
    "robot placed elsewhere": Fault(7, _place),
    "new goal": Fault(30, _new_goal),
}
_ROWS = {
    "replayed": 14, "foreign": 15, "oversize": 17, "odd values": 19, "services": 29, "lockout": 46, "states": 48,
    "senders": 50,
}  # fmt: skip
_JUNK_ROW, _FLOOD_ROW = 18, 17
_INTRUSIONS = {
    f"stranger: {kind}": Fault(
        _FLOOD_ROW if kind.startswith("flood") else _ROWS.get(kind, _JUNK_ROW), partial(_intrude, kind=kind)
    )
    for kind in KINDS
}
_SENDERS = "stranger: senders"  # the recorder keeps a channel of each: its memory grows, by design
HARMLESS |= {name: fault for name, fault in _INTRUSIONS.items() if name != _SENDERS}
DEADLY: dict[str, Fault] = {
    "executive killed": Fault(1, partial(_kill, names=("executive",))),
    "simulator killed": Fault(6, partial(_kill, names=("sim",))),
    "executive and simulator killed": Fault(41, partial(_kill, names=("executive", "sim"))),
    "recorder killed": Fault(9, _kill_recorder),
    "gateway killed": Fault(42, _kill_gateway),
    "launcher killed": Fault(10, _kill_launcher),
    "executive frozen 2 s": Fault(3, partial(_freeze, name="executive", seconds=2.0)),
    "simulator frozen 2 s": Fault(53, partial(_freeze, name="sim", seconds=2.0)),
    "gateway frozen 2 s": Fault(42, partial(_freeze, name="gateway", seconds=2.0)),
    "recorder frozen 2 s": Fault(53, partial(_freeze, name="record", seconds=2.0)),
    "disarmed, then executive killed": Fault(41, partial(_then_kill, first=_disarm, name="executive")),
    "e-stop, then simulator killed": Fault(41, partial(_then_kill, first=_estop, name="sim")),
    "Ctrl-C, another scenario": Fault(11, _restart),
    _SENDERS: _INTRUSIONS[_SENDERS],
}
FAULTS = HARMLESS | DEADLY
