"""Faults that a soak injects, and what each entitles the judge to expect; rows of the project's table of faults.

Not among them: what needs a namespace or a proxy between executive and driver. A frozen launcher, whose process is the
router, cuts everybody off from everybody instead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from tailor.tools.soak.faults import people_faults as people
from tailor.tools.soak.faults import process_faults as processes
from tailor.tools.soak.faults.intrusions import KINDS
from tailor.tools.soak.faults.scene import Scene


@dataclass(frozen=True, slots=True)
class Fault:
    """One kind of fault."""

    row: int
    inject: Callable[[Scene], None]


def _then_kill(scene: Scene, first: Callable[[Scene], None], name: str) -> None:
    first(scene)
    processes.kill(scene, (name,))


HARMLESS: dict[str, Fault] = {
    "executive frozen 0.2 s": Fault(3, partial(processes.freeze, name="executive", seconds=0.2)),
    "simulator frozen 0.2 s": Fault(3, partial(processes.freeze, name="sim", seconds=0.2)),
    "recorder frozen 0.2 s": Fault(9, partial(processes.freeze, name="record", seconds=0.2)),
    "router frozen 0.2 s": Fault(13, partial(processes.freeze, name="up", seconds=0.2)),
    "router frozen 2 s": Fault(12, partial(processes.freeze, name="up", seconds=2.0)),
    "4 CPU burners": Fault(25, people.burn),
    "e-stop": Fault(38, people.estop),
    "e-stop of a new session": Fault(38, people.estop_from_new_session),
    "e-stop beside CPU burners": Fault(38, partial(people.burn, then=people.estop)),
    "e-stop beside silent connections": Fault(
        42, partial(people.silent_connections, then=people.estop_from_new_session)
    ),
    "silent connections": Fault(42, people.silent_connections),
    "disarmed": Fault(41, people.disarm),
    "disk full for the recorder": Fault(9, processes.disk_full),
    "world reset": Fault(7, people.reset),
    "robot placed elsewhere": Fault(7, people.place),
    "new goal": Fault(30, people.new_goal),
}
_ROWS = {
    "replayed": 14, "foreign": 15, "oversize": 17, "odd values": 19, "services": 29, "lockout": 46, "states": 48,
    "senders": 50, "arming": 16,
}  # fmt: skip
_JUNK_ROW, _FLOOD_ROW = 18, 17
_INTRUSIONS = {
    f"stranger: {kind}": Fault(
        _FLOOD_ROW if kind.startswith("flood") else _ROWS.get(kind, _JUNK_ROW), partial(Scene.intrude, kind=kind)
    )
    for kind in KINDS
}
_SENDERS = "stranger: senders"  # the recorder keeps a channel of each: its memory grows, by design
HARMLESS |= {name: fault for name, fault in _INTRUSIONS.items() if name != _SENDERS}
DEADLY: dict[str, Fault] = {
    "executive killed": Fault(1, partial(processes.kill, names=("executive",))),
    "simulator killed": Fault(6, partial(processes.kill, names=("sim",))),
    "executive and simulator killed": Fault(41, partial(processes.kill, names=("executive", "sim"))),
    "recorder killed": Fault(9, processes.kill_recorder),
    "gateway killed": Fault(42, processes.kill_gateway),
    "launcher killed": Fault(10, processes.kill_launcher),
    "executive frozen 2 s": Fault(3, partial(processes.freeze, name="executive", seconds=2.0)),
    "simulator frozen 2 s": Fault(53, partial(processes.freeze, name="sim", seconds=2.0)),
    "gateway frozen 2 s": Fault(42, partial(processes.freeze, name="gateway", seconds=2.0)),
    "recorder frozen 2 s": Fault(53, partial(processes.freeze, name="record", seconds=2.0)),
    "disarmed, then executive killed": Fault(41, partial(_then_kill, first=people.disarm, name="executive")),
    "e-stop, then simulator killed": Fault(41, partial(_then_kill, first=people.estop, name="sim")),
    "Ctrl-C, another scenario": Fault(11, processes.restart),
    _SENDERS: _INTRUSIONS[_SENDERS],
}
FAULTS = HARMLESS | DEADLY
SETTLING = ("router frozen 2 s", "silent connections") * 2  # the bus starts threads and fills pools the first times
