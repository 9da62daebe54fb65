"""A message type is a dataclass and a row of the table of topics; everything else is derived."""

from dataclasses import dataclass

import pytest

from tailor.schemas.messages import InstantiatedAction, Parameter, Subgoals
from tailor.schemas.msg_definitions import declarations, with_parts
from tailor.schemas.msg_files import FOLDER, msg_files


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
