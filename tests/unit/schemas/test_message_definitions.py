"""A message type is a dataclass and a row of the table of topics; everything else is derived."""

import subprocess
import sys
from dataclasses import dataclass

import pytest

from tailor.schemas.messages import InstantiatedAction, Parameter, Subgoals
from tailor.schemas.msg_definitions import declarations, with_parts
from tailor.schemas.msg_files import FOLDER, msg_files

NEW_MESSAGE = """
from dataclasses import dataclass
from tailor.schemas.messages import Message
from tailor.schemas.topics import TOPICS, Topic

@dataclass(frozen=True, slots=True)
class Gripper(Message):
    stamp_ns: int
    width_m: float
    fingers: tuple[str, ...] = ()

TOPICS["gripper"] = Topic("{robot}/gripper", Gripper, 10, "driver")

from tailor.schemas.codec import decode, encode, prime
from tailor.schemas.typesystem import definition, ros_type, type_hash, type_of
prime()
message = Gripper(5, 0.02, ("left", "right"))
assert decode(TOPICS["gripper"], encode(message)) == message
assert type_of(ros_type(Gripper)) is Gripper
assert type_hash(Gripper).startswith("RIHS01_")
print(definition(Gripper).split("=" * 80)[0])
"""


def test_a_new_message_needs_its_dataclass_and_a_row_of_topics_only():
    run = subprocess.run([sys.executable, "-P", "-c", NEW_MESSAGE], capture_output=True, text=True, check=True)
    assert run.stdout.split("\n")[:3] == ["std_msgs/Header header", "float64 width_m", "string[] fingers"]


def test_the_msg_files_are_those_that_the_command_writes():
    files = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.msg")}
    assert files == msg_files(), "run: python -m tailor.schemas.msg_files"


def test_msg_files_are_plain_ascii_for_the_generators_of_ros():
    assert all(text.isascii() for text in msg_files().values())


def test_nested_types_come_before_the_types_that_contain_them():
    assert with_parts([Subgoals]) == (Parameter, InstantiatedAction, Subgoals)


def test_a_field_that_ros_has_no_type_for_is_refused_by_name():
    @dataclass
    class Strange:
        table: dict

    with pytest.raises(TypeError, match="'table'"):
        declarations(Strange)
