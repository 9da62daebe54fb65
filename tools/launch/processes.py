"""The processes of a system, as the launcher starts them: command lines, ids, and limits of their silence."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig
from tailor.runtime.processes.child import tailor
from tailor.runtime.processes.supervised import ProcessSpec
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.launch.senders import Senders

EXECUTIVE_SILENCE_NS = 1_000_000_000  # ten ticks
SIM_SILENCE_NS = 2_000_000_000  # two hundred periods; physics may be late on a busy machine
RECORDER_SILENCE_NS = 10_000_000_000  # a disk may be slow
SCENE_SILENCE_NS = 10_000_000_000  # it has the lowest priority of all


@dataclass(frozen=True, slots=True)
class LaunchConfig:
    """Configuration of one system."""

    executive: ExecutiveConfig
    bus: BusSettings
    record: Path | None = None  # MCAP file to write
    once: bool = False  # end when the goal is achieved or has failed
    deployment_file: str = ""  # passed on to the executive
    planner: str = ""  # command of an external planner that people chose, also passed on: it chooses others by itself
    require_recording: bool = False  # end when the recording ends or lacks something
    scene: bool = False  # publish markers and transforms for viewers in 3D
    hardware: str = ""  # FILE.toml or MODULE:CLASS of a real robot; empty: the simulator

    @property
    def driver(self) -> str:
        """Name of the process that holds the robot's guard."""
        return "driver" if self.hardware else "sim"


def record_process(config: LaunchConfig, senders: Senders) -> ProcessSpec:
    """The recorder. It is never started again: its file exists."""
    argv = tailor("record", "--output", str(config.record), "--connect", config.bus.endpoint)
    arguments = partial(senders.arguments, "record")
    return ProcessSpec("record", argv, restarts=False, silence_ns=RECORDER_SILENCE_NS, arguments=arguments)


def scene_process(config: LaunchConfig, senders: Senders) -> ProcessSpec:
    """Markers and transforms; no other process needs it."""
    argv = tailor("scene", "--live", "--connect", config.bus.endpoint)
    return ProcessSpec("scene", argv, silence_ns=SCENE_SILENCE_NS, arguments=partial(senders.arguments, "scene"))


def sim_process(config: LaunchConfig, senders: Senders, robot: str) -> ProcessSpec:
    """The simulated robot; only its first start gives the first executive leave to arm it."""
    executive = config.executive
    scene = ("--scenario", executive.scenario, "--seed", str(executive.settings.seed))

    def arguments(start: int) -> tuple[str, ...]:
        leave = ("--leave", senders.leave) if start == 1 else ()
        return (*senders.arguments("sim", start), *leave)

    argv = tailor("sim", robot, *scene, "--connect", config.bus.endpoint)
    return ProcessSpec("sim", argv, must_begin=True, silence_ns=SIM_SILENCE_NS, arguments=arguments)


def hardware_process(config: LaunchConfig, senders: Senders) -> ProcessSpec:
    """The driver of a real robot. It gets no leave, so a person arms it after every start."""
    argv = tailor("driver", config.hardware, "--connect", config.bus.endpoint)
    arguments = partial(senders.arguments, "driver")
    return ProcessSpec("driver", argv, must_begin=True, silence_ns=SIM_SILENCE_NS, arguments=arguments)


def executive_process(config: LaunchConfig, senders: Senders) -> ProcessSpec:
    """The executive. Only its first start has the goal of the scenario: a restart is no resume.

    What people have asked for since is lost with the process: to drop the goal, another one, or what was done of it.
    """
    executive = config.executive
    flags = ["--scenario", executive.scenario, "--seed", str(executive.settings.seed), "--connect", config.bus.endpoint]
    flags += ["--horizon", str(executive.settings.refinement.horizon)]
    flags += ["--planner", config.planner]
    flags += ["--config", config.deployment_file] if config.deployment_file else []
    flags += ["--zoo", executive.zoo] if executive.zoo else []

    def arguments(start: int) -> tuple[str, ...]:
        wait = ("--wait",) if start > 1 else ()
        return (*wait, "--driver-sender", senders.of(config.driver), *senders.arguments("executive", start))

    return ProcessSpec(
        "executive",
        tailor("executive", executive.domain, *flags),
        silence_ns=EXECUTIVE_SILENCE_NS,
        arguments=arguments,
        restart_note=", without a goal: arm the robot, then `tailor goal` sends one",
    )
