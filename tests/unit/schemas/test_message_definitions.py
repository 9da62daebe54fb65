"""A message type is a dataclass and a row of the table of topics; everything else is derived."""

from dataclasses import dataclass

import pytest

from tailor.schemas.messages import InstantiatedAction, Parameter, Subgoals
from tailor.schemas.packages.msg_definitions import declarations, with_parts


def test_nested_types_come_before_the_types_that_contain_them():
    assert with_parts([Subgoals]) == (Parameter, InstantiatedAction, Subgoals)


def test_a_field_that_ros_has_no_type_for_is_refused_by_name():
    @dataclass
    class Strange:
        table: dict

    with pytest.raises(TypeError, match="'table'"):
        declarations(Strange)
