"""The service that sets a goal: its bytes are total to read, and its type hash is computed as ROS 2 does."""

import pytest

from tailor.schemas.errors import Rejected
from tailor.schemas.ros2 import service
from tailor.schemas.typesystem import add_service, hash_of


def test_the_hash_of_a_service_is_the_one_that_ros_2_publishes():
    add_service("std_srvs/srv/SetBool", "bool data", "bool success\nstring message")
    known = "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a"  # std_srvs 5.5.1
    assert hash_of("std_srvs/srv/SetBool") == known


def test_request_and_response_survive_their_bytes():
    assert service.goal_of(service.request("(atball pos3)")) == "(atball pos3)"
    assert service.result_of(service.response(False, "no such predicate")) == (False, "no such predicate")


def test_a_request_has_the_bytes_of_a_string():
    assert service.request("ab").hex() == "00010000" "03000000" "616200"  # fmt: skip


def test_padding_of_real_serializers_is_accepted():
    assert service.goal_of(service.request("ab") + b"\0") == "ab"


@pytest.mark.parametrize(
    "data", [b"", b"\0\1\0\0", b"\0\1\0\0\xff\xff\xff\xff", b"\0" * 70_000, b"\0\1\0\0" + b"\0" * 30]
)
def test_damaged_bytes_are_refused(data):
    assert isinstance(service.goal_of(data), Rejected)
    assert isinstance(service.result_of(data), Rejected)
