"""Topics of a robot's package enter table, codec, access rules and recordings without an edit of ours."""

from dataclasses import dataclass, make_dataclass, replace
from typing import Any, ClassVar

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
message = Gripper(5, 0.02, ("left", "right"), (True, False))
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


def message(*fields: tuple[str, Any], **names: str) -> type:
    """A message of a package with these fields."""
    namespace = {"ROS_PACKAGE": "courier_msgs", **names}
    return make_dataclass("Made", fields, bases=(Message,), namespace=namespace, frozen=True)


Part = make_dataclass("Part", [("x", dict)], frozen=True)
Shape = make_dataclass("Shape", [("x", float)], frozen=True)  # also a part of our scenes
STAMP = ("stamp_ns", int)
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
    "7: expected text as the name": {7: GOOD},
    "key is None, expected text": {"grip": replace(GOOD, key=None)},
    "key is '{robot}//grip'": {"grip": replace(GOOD, key="{robot}//grip")},
    "key is '{robot}/'": {"grip": replace(GOOD, key="{robot}/")},
    "key is '{robot}/a grip'": {"grip": replace(GOOD, key="{robot}/a grip")},
    "rate_hz is '10'": {"grip": replace(GOOD, rate_hz="10")},
    "fresh_s is '0.5'": {"grip": replace(GOOD, fresh_s="0.5")},
    "fresh_s is 0": {"grip": replace(GOOD, fresh_s=0)},
    "max_bytes is '4096'": {"grip": replace(GOOD, max_bytes="4096")},
    "max_bytes is -1": {"grip": replace(GOOD, max_bytes=-1)},
    "recorded is 'no'": {"grip": replace(GOOD, recorded="no")},
}
TYPES = {
    "field 'x' is <class 'dict'>, expected int, float, bool": message(("x", dict)),
    "field 'x' may be None": message(("x", float | None)),
    "type Part: field 'x' is <class 'dict'>": message(("x", tuple[Part, ...])),
    "type Shape has the name tailor_msgs/msg/Shape of another": message(("x", tuple[Shape, ...])),
    "name 'Missing' is not defined": message(("x", "Missing")),
    "expected at least one field": message(),
    "expected stamp_ns: int as the first field": message(("x", float), STAMP),
    "no field 'header' beside it": message(STAMP, ("header", int)),
    "field '_x', expected a name of ROS 2": message(("_x", float)),
    "its ROS name is 'my msgs/msg/Made'": message(STAMP, ROS_PACKAGE="my msgs"),
    "ROS_TYPE is 'my_msgs/msg/X', expected one of ROS 2's": message(STAMP, ROS_TYPE="my_msgs/msg/X"),
    "are not those of std_msgs/msg/Float64: data": message(("value", float), ROS_TYPE="std_msgs/msg/Float64"),
    "has the ROS_TYPE 5, expected text": message(STAMP, ROS_TYPE=5),
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


@pytest.mark.parametrize("fault", TYPES)
def test_a_type_that_no_codec_carries_is_refused_for_its_own_package_alone(fault, monkeypatch):
    result = added({"grip": replace(GOOD, type=TYPES[fault])}, monkeypatch)
    assert fault in "; ".join(result.faults["courier"])
    assert set(result.topics) == set(TOPICS)


@pytest.mark.parametrize(
    "kind",
    [
        message(("data", float), ROS_TYPE="std_msgs/msg/Float32"),
        message(STAMP, ("flags", tuple[bool, ...]), ("names", tuple[str, ...])),
    ],
)
def test_a_type_that_a_codec_carries_is_accepted(kind, monkeypatch):
    assert added({"grip": replace(GOOD, type=kind)}, monkeypatch).faults == {}
