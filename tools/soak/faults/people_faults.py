"""Faults that people cause, and those of the machine beside them: stops, new worlds, connections, CPU burners."""

from __future__ import annotations

import json
import socket
from collections.abc import Callable
from contextlib import ExitStack

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import EStop
from tailor.schemas.services import DROP
from tailor.tools.soak.faults.scene import Scene
from tailor.tools.soak.systems.sessions import open_people

ESTOP_S = 0.2  # from people's request to zero
SILENT = 110
SILENT_S = 2.0
BURN_S = 10.0


def estop(scene: Scene) -> None:
    """People's e-stop, from a session that is open."""
    scene.begin()
    scene.people.estop(scene.now_ns(), ESTOP_S)
    scene.run_for(1.0)


def estop_from_new_session(scene: Scene) -> None:
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


def disarm(scene: Scene) -> None:
    """People's disarming."""
    scene.people.disarm(scene.now_ns(), ESTOP_S)
    scene.run_for(0.5)


def silent_connections(scene: Scene, then: Callable[[Scene], None] | None = None) -> None:
    """Connections that send nothing, as of a port scan; `then`: another fault beside them."""
    host, port = scene.system.endpoint.removeprefix("tcp/").split(":")
    with ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(socket.create_connection((host, int(port))))
        if then is not None:
            then(scene)
        scene.run_for(SILENT_S)


def burn(scene: Scene, then: Callable[[Scene], None] | None = None) -> None:
    """More processes that compute than there are cores; `then`: another fault beside them."""
    with scene.burners():
        scene.run_for(BURN_S / 2)
        if then is not None:
            then(scene)
        scene.run_for(BURN_S / 2)


def _start_values(scene: Scene) -> dict[str, float]:
    seed = scene.draw.randrange(10_000)
    return domains.seeded_scenario(scene.system.robot.domain, scene.system.scenario, seed)[1]


def reset(scene: Scene) -> None:
    """The world starts anew while the robot moves."""
    _call(scene, "reset", {"seed": scene.draw.randrange(10_000), "start": _start_values(scene)})


def place(scene: Scene) -> None:
    """Robot and ball are somewhere else of a sudden, at rest."""
    _call(scene, "place", _start_values(scene))


def _call(scene: Scene, service: str, argument: dict[str, object] | dict[str, float]) -> None:
    accepted, reply = scene.system.call(f"{scene.system.robot.name}/sim/{service}", json.dumps(argument))
    if not accepted:
        scene.record.notes.append(f"{service}: {reply}")


def new_goal(scene: Scene) -> None:
    """The goal is dropped and set anew while the robot pursues it: the same one that is set again changes nothing."""
    scene.system.call("exec/goal", DROP)
    scene.people.set_goal()
