"""Faults of processes: killed, frozen, ended, without a disk."""

from __future__ import annotations

import resource
import signal

from tailor.tools.soak.faults.scene import Scene
from tailor.tools.soak.systems.system import send_signal

GUARD_S = 0.3  # the guard's timeout
FULL_S = 5.0


def kill(scene: Scene, names: tuple[str, ...]) -> None:
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


def kill_recorder(scene: Scene) -> None:
    """Motion goes on; a recorder that nobody starts again is people's affair: they restart the system."""
    before = scene.pid("record")
    send_signal(before, signal.SIGKILL)
    back = scene.wait(lambda: scene.system.pid("record") not in (None, before), 5.0)
    if not back:
        scene.record.body_ends = True
        scene.restart(scene.system, signal.SIGINT)


def kill_gateway(scene: Scene) -> None:
    """Only sessions from elsewhere are cut off."""
    before = scene.pid("gateway")
    send_signal(before, signal.SIGKILL)
    scene.expect_back(lambda: scene.system.pid("gateway") not in (None, before))


def freeze(scene: Scene, name: str, seconds: float) -> None:
    """SIGSTOP, and SIGCONT later; the launcher kills an executive that is silent for a second."""
    pid, heard = scene.pid(name), scene.heard_ids()
    dies = name == "executive" and seconds > GUARD_S
    if dies:
        scene.system.judge.revoke(scene.now_ns(), GUARD_S)
    send_signal(pid, signal.SIGSTOP)
    try:
        scene.run_for(seconds)
    finally:
        send_signal(pid, signal.SIGCONT)
    scene.expect_back(lambda: not dies or scene.heard_ids().get(name) not in (None, heard.get(name)))


def kill_launcher(scene: Scene) -> None:
    """Its children end with it; people start the system again."""
    scene.record.body_ends = True
    scene.system.judge.revoke(scene.now_ns())
    scene.restart(scene.system, signal.SIGKILL)


def restart(scene: Scene) -> None:
    """Ctrl-C in motion, and another scenario."""
    scene.record.body_ends = True
    scene.restart(scene.system, signal.SIGINT)


def disk_full(scene: Scene) -> None:
    """Of the recorder alone: its files cannot grow."""
    pid = scene.pid("record")
    size = scene.system.recordings[-1].stat().st_size
    unlimited = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (size, unlimited[1]))
    scene.run_for(FULL_S)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, unlimited)
