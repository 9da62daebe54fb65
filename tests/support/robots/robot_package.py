"""Packages of robots outside Tailor, as pip leaves them in a folder of the path."""

import os
import subprocess
import sys
from pathlib import Path

SPEC = """
from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    "courier",
    "pedelec",
    "courier_robot.domain:make",
    draw="courier_robot.domain:draw",
    topics="courier_robot.messages:TOPICS",
)
"""
MESSAGES = """
from dataclasses import dataclass
from typing import ClassVar
from tailor.schemas.messages import Message
from tailor.schemas.topics import Topic

@dataclass(frozen=True, slots=True)
class Gripper(Message):
    ROS_PACKAGE: ClassVar[str] = "courier_msgs"
    stamp_ns: int
    width_m: float
    fingers: tuple[str, ...] = ()
    held: tuple[bool, ...] = ()

TOPICS = {
    "claw": Topic("{robot}/claw", Gripper, 10, "driver"),
    "grip": Topic("{robot}/grip", Gripper, 10, "executive", priority="real_time", max_bytes=100),
}
"""


def install(site: Path, files: dict[str, str], points: dict[str, str]) -> None:
    """Write the package `courier_robot` and its entry points of the group `tailor.domains`."""
    for name, text in files.items():
        path = site / "courier_robot" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    info = site / "courier_robot-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: courier-robot\nVersion: 1.0\n")
    rows = "".join(f"{name} = {value}\n" for name, value in points.items())
    (info / "entry_points.txt").write_text(f"[tailor.domains]\n{rows}")


def run_with(site: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """Run Python with an installed folder on its path."""
    environment = {**os.environ, "PYTHONPATH": str(site)}
    return subprocess.run([sys.executable, "-P", *command], capture_output=True, text=True, timeout=60, env=environment)
