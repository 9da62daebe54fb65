"""Hardware as people name it: a file of plain topics drives robots that obey cmd_vel alone."""

import errno
import io
import os
import time
from types import SimpleNamespace

import pytest

from tailor.executive import domains
from tailor.executive.composition import ExecutiveConfig
from tailor.runtime.aside import aside
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.commands.drivers.driver import reporter
from tailor.tools.commands.run.up import _check_hardware
from tailor.tools.launch.hardware import check_sensors, hardware_of
from tailor.tools.launch.processes import LaunchConfig
from tests.support.patience import wait_until

ELSEWHERE = '[bus]\nconnect = "tcp/192.0.2.1:7447"\n'
REFUSED = {
    "b21": "b21 obeys cmd_vel, joint_cmd, gripper_cmd, but plain topics carry cmd_vel alone",
    "powercube": "powercube obeys joint_cmd, but plain topics carry cmd_vel alone",
}


@pytest.mark.parametrize("robot", REFUSED)
def test_a_robot_that_obeys_other_commands_is_refused(tmp_path, robot):
    file = tmp_path / "robot.toml"
    file.write_text(f'robot = "{robot}"\n{ELSEWHERE}')
    with pytest.raises(UsageError, match=REFUSED[robot]):
        hardware_of(str(file), "tcp/127.0.0.1:7447")


@pytest.mark.parametrize("robot", ["agilo", "nobody"])
def test_one_that_obeys_cmd_vel_is_not_nor_one_whose_commands_nobody_knows_yet(tmp_path, robot):
    file = tmp_path / "robot.toml"
    file.write_text(f'robot = "{robot}"\n{ELSEWHERE}')
    assert hardware_of(str(file), "tcp/127.0.0.1:7447").robot == robot


def test_a_domain_that_requires_what_plain_topics_do_not_carry_is_refused_at_once(tmp_path, monkeypatch):
    file = tmp_path / "robot.toml"
    file.write_text(f'robot = "agilo"\n{ELSEWHERE}')
    config = LaunchConfig(ExecutiveConfig("soccer", "waypoints"), BusSettings(), hardware=str(file))
    _check_hardware(config)
    monkeypatch.setattr(domains, "load", lambda name: SimpleNamespace(required=("odom", "gyro", "pose", "tags")))
    with pytest.raises(UsageError, match=r"requires gyro, tags, but plain topics carry odom and pose alone"):
        _check_hardware(config)
    check_sensors("package:Robot", ("odom", "gyro"))  # a class measures what it likes


@pytest.mark.parametrize(
    ("bus", "fault"),
    [
        ('connect = "192.168.0.7:7447"', "bus endpoint '192.168.0.7:7447': expected PROTOCOL/HOST:PORT"),
        ('connect = "tls/192.0.2.1:7448"\nkey = "/nowhere"', "/nowhere: no authority.pem, expected a folder"),
    ],
)
def test_a_bus_that_can_never_be_opened_is_refused_at_once_and_not_tried_for_ever(tmp_path, bus, fault):
    file = tmp_path / "robot.toml"
    file.write_text(f'robot = "agilo"\n[bus]\n{bus}\n')
    with pytest.raises(UsageError) as refused:
        hardware_of(str(file), "tcp/127.0.0.1:7447")
    assert str(refused.value).startswith(f"{file}: {fault}")


def test_what_a_device_says_reaches_a_terminal_without_its_control_characters(capsys):
    with aside() as terminal:
        reporter("agilo", terminal)("not ready: read: OSError: unexpected \x1b[2J")
    assert capsys.readouterr().err == "agilo: not ready: read: OSError: unexpected \\x1b[2J\n"


class FullDisk(io.StringIO):
    def flush(self):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_driver_whose_log_is_on_a_full_disk_goes_on(monkeypatch):
    monkeypatch.setattr("sys.stderr", FullDisk())
    with aside() as terminal:
        report = reporter("agilo", terminal)
        for _ in range(3):
            report("ready")
            wait_until(lambda: not terminal._waiting)
            time.sleep(0.01)  # until the last one is made
    assert terminal._error is None
