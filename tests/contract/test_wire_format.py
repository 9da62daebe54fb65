"""The bytes on the wire, pinned: other nodes and old recordings rely on them.

After a deliberate change of a message, `python -m tests.contract.test_wire_format` writes the pinned values again.
"""

import json
from pathlib import Path

import pytest

from tailor.schemas import messages as m
from tailor.schemas.codec import decode, encode
from tailor.schemas.packages.msg_definitions import field_types
from tailor.schemas.typesystem import definition, message_types, ros_type, type_hash, type_of, typestore
from tests.support.filled import filled

PINNED = Path(__file__).resolve().parents[1] / "data" / "messages.json"
MESSAGES = message_types()
OWN = [kind for kind in MESSAGES if not kind.ROS_TYPE]

# A TwistStamped as CDR, field by field.
TWIST = bytes.fromhex(
    "00010000"  # little-endian CDR
    "01000000" "0765cd1d"  # stamp: 1 s, 500000007 ns
    "0a000000" "626173655f6c696e6b00" "0000"  # frame_id "base_link", padding to 4; doubles want 8
    "000000000000d03f" "0000000000000000" "0000000000000000"  # linear: 0.25, 0, 0
    "0000000000000000" "0000000000000000" "000000000000f8bf"  # angular: 0, 0, -1.5
)  # fmt: skip


def test_a_command_has_the_bytes_of_a_twist_stamped():
    command = m.VelocityCommand(1_500_000_007, 0.25, -1.5)
    assert encode(command) == TWIST
    assert decode(m.VelocityCommand, TWIST) == command


def test_big_endian_senders_are_understood():
    bool_be = bytes.fromhex("0000000001")
    assert decode(m.EStop, bool_be) == m.EStop(True)


def test_an_arming_request_has_these_bytes():
    expected = "00010000010000000300000061620000000000000500000000000000"
    assert encode(m.ArmRequest(True, False, "ab", 5)).hex() == expected


def test_type_hashes_are_those_of_ros_2():
    known = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"  # of std_msgs/msg/String
    assert typestore().hash_rihs01("std_msgs/msg/String") == known


@pytest.mark.parametrize("kind", OWN)
def test_a_definition_has_the_fields_of_its_message_in_their_order(kind):
    own_part = definition(kind).split("=" * 80)[0]
    names = [line.split()[1] for line in own_part.splitlines() if line.strip()]
    expected = ["header" if name == "stamp_ns" else name for name in field_types(kind)]
    assert names == expected


@pytest.mark.parametrize("kind", MESSAGES)
def test_a_types_name_leads_back_to_it(kind):
    assert type_of(ros_type(kind)) is kind
    assert type_hash(kind).startswith("RIHS01_")


def test_an_unknown_type_is_none_of_ours():
    assert type_of("sensor_msgs/msg/Image") is None
    assert not hasattr(type_of, "cache_info"), "strangers choose names: a cache of them would grow without end"


def wire_format():
    """Type hash and bytes of every message type, by ROS name."""
    return {
        ros_type(kind): {"hash": type_hash(kind), "example": encode(filled(kind)).hex()}
        for kind in sorted(MESSAGES, key=ros_type)
    }


def test_type_hashes_and_bytes_of_all_messages_are_the_pinned_ones():
    assert wire_format() == json.loads(PINNED.read_text())


@pytest.mark.parametrize("kind", MESSAGES)
def test_a_filled_message_is_read_back_from_its_bytes(kind):
    message = filled(kind)
    assert encode(decode(kind, encode(message))) == encode(message)


if __name__ == "__main__":
    PINNED.write_text(json.dumps(wire_format(), indent=1) + "\n")
