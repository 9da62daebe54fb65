"""Topics of a robot's package enter table, codec, access rules and recordings without an edit of ours."""

from dataclasses import dataclass, replace
from typing import ClassVar

import pytest

from tailor.schemas.messages import ArmRequest, Message, VelocityCommand
from tailor.schemas.packages.discovery import Package
from tailor.schemas.packages.package_topics import add_topics
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.packages.topic import Topic
from tailor.schemas.topics import TOPICS
from tests.support.robots.robot_package import MESSAGES, SPEC, install, run_with

USE = """
import json
from tailor.schemas.codec import decode, encode, prime
from tailor.schemas.topics import TOPICS, key_of
from tailor.schemas.typesystem import definition, ros_type, type_hash, type_of
from courier_robot.messages import Gripper
prime()
message = Gripper(5, 0.02, ("left", "right"))
assert decode(TOPICS["claw"], encode(message)) == message
assert decode(TOPICS["grip"], encode(Gripper(5, 0.02, ("x" * 100,)))).reason == "too long"
assert ros_type(Gripper) == "courier_msgs/msg/Gripper"
assert type_of(ros_type(Gripper)) is Gripper
assert type_hash(Gripper).startswith("RIHS01_")
assert key_of("claw", "pedelec") == "pedelec/claw"
from tailor.runtime.bus.rights.access import access_control, size_limits
rules = {rule["id"]: rule["key_exprs"] for rule in access_control([])["rules"]}
assert [name for name, keys in rules.items() if "*/claw" in keys] == ["driver publish", "player publish"]
assert [name for name, keys in rules.items() if "*/grip" in keys] == ["executive publish"]
assert [row["size_limit"] for row in size_limits() if "*/grip" in row["key_exprs"]] == [100]
from tailor.schemas.ros2.interface_package import msg_files
assert "Gripper.msg" not in msg_files()
print(definition(Gripper).split("=" * 80)[0])
"""
FILES = {"__init__.py": SPEC, "messages.py": MESSAGES}
POINTS = {"courier": "courier_robot:SPEC"}


def test_a_message_of_a_package_needs_no_edit_of_ours(tmp_path):
    install(tmp_path, FILES, POINTS)
    done = run_with(tmp_path, "-c", USE)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[:3] == ["std_msgs/Header header", "float64 width_m", "string[] fingers"]


@pytest.mark.parametrize("first", ["courier_robot.messages", "courier_robot", "tailor.schemas.codec"])
def test_any_module_may_be_imported_first(tmp_path, first):
    install(tmp_path, FILES, POINTS)
    code = f"import {first}; from tailor.schemas.topics import TOPICS; assert 'claw' in TOPICS, TOPICS.faults"
    done = run_with(tmp_path, "-c", code)
    assert done.returncode == 0, done.stderr


def test_a_package_with_bad_topics_is_refused_and_hinders_no_other(tmp_path):
    bad = MESSAGES.replace("{robot}/claw", "estop").replace('"executive"', '"people"')
    install(tmp_path, {**FILES, "messages.py": bad}, POINTS)
    done = run_with(tmp_path, "-m", "tailor.tools.main", "executive", "courier")
    assert done.returncode == 2
    assert len(done.stderr.strip().split("\n")) == 1
    assert "courier_robot:SPEC: topics = 'courier_robot.messages:TOPICS': 'claw' has the key estop" in done.stderr
    assert "'grip': source is 'people'" in done.stderr
    code = "from tailor.schemas.installed import domain_names; from tailor.schemas.topics import TOPICS;"
    assert (
        run_with(tmp_path, "-c", f"{code} print(*domain_names(), 'claw' in TOPICS)").stdout
        == "arm kitchen soccer False\n"
    )


@dataclass(frozen=True, slots=True)
class Grip(Message):
    ROS_PACKAGE: ClassVar[str] = "courier_msgs"
    stamp_ns: int


@dataclass(frozen=True, slots=True)
class Unnamed(Message):
    stamp_ns: int


@dataclass(frozen=True, slots=True)
class Imitated(Message):
    ROS_TYPE: ClassVar[str] = "std_msgs/msg/Bool"
    stamp_ns: int


GOOD = Topic("{robot}/grip", Grip, 10, "driver")
ROWS = {
    "is a int, expected a table": 7,
    "'grip' is a int, expected a Topic": {"grip": 7},
    "'odom' is a topic already, expected a name of its own, such as 'pedelec_odom'": {"odom": GOOD},
    "'grip' has the key {robot}/odom of 'odom'": {"grip": replace(GOOD, key="{robot}/odom")},
    "'other' has the key {robot}/grip of 'grip'": {"grip": GOOD, "other": GOOD},
    "key is 'exec/status2'": {"grip": replace(GOOD, key="exec/status2")},
    "key is '{robot}/**'": {"grip": replace(GOOD, key="{robot}/**")},
    "source is 'launcher'": {"grip": replace(GOOD, source="launcher")},
    "priority is 'urgent'": {"grip": replace(GOOD, priority="urgent")},
    "priority is real_time, which is for commands": {"grip": replace(GOOD, priority="real_time")},
    "rate_hz is nan": {"grip": replace(GOOD, rate_hz=float("nan"))},
    "type is ArmRequest, which no package publishes": {"grip": replace(GOOD, type=ArmRequest)},
    "expected a frozen dataclass derived from Message": {"grip": replace(GOOD, type=int)},
    "has the ROS_PACKAGE tailor_msgs": {"grip": replace(GOOD, type=Unnamed)},
    "has the name std_msgs/msg/Bool of another": {"grip": replace(GOOD, type=Imitated)},
}


def added(table, monkeypatch):
    monkeypatch.setattr("tests.unit.schemas.test_package_topics.OFFERED", table, raising=False)
    spec = DomainSpec("courier", "pedelec", "m:make", draw="m:draw", topics=f"{__name__}:OFFERED")
    return add_topics(TOPICS, [Package("courier", "m:SPEC", spec, ())])


def test_good_topics_are_added(monkeypatch):
    result = added({"grip": GOOD, "twist": Topic("{robot}/twist", VelocityCommand, 10, "executive")}, monkeypatch)
    assert result.faults == {}
    assert {"odom", "grip", "twist"} <= set(result.topics)


@pytest.mark.parametrize("fault", ROWS)
def test_each_fault_is_named(fault, monkeypatch):
    result = added(ROWS[fault], monkeypatch)
    assert fault in "; ".join(result.faults["courier"])
    assert set(result.topics) == set(TOPICS)
