"""A topic whose other end has another type is named; one that somebody hears is not."""

import pytest

from tailor.schemas.ros2.graph import Announced, Kind, Named
from tailor.schemas.ros2.type_mismatches import mismatches

HASH = "RIHS01_" + "9c" * 32
TWIST, STAMPED = (Named("cmd_vel", f"geometry_msgs/msg/{name}", HASH) for name in ("Twist", "TwistStamped"))
OTHER = Named("cmd_vel", TWIST.type, "RIHS01_" + "0b" * 32)
ELSEWHERE = Named("base/cmd_vel", STAMPED.type, HASH)
PUB, SUB, NODE = Kind.PUBLISHER, Kind.SUBSCRIPTION, Kind.NODE


@pytest.mark.parametrize(
    ("ours", "others", "line"),
    [
        ((PUB, TWIST), [(SUB, STAMPED)], "cmd_vel: a subscriber of geometry_msgs/msg/TwistStamped, we publish "
         "geometry_msgs/msg/Twist"),
        ((SUB, STAMPED), [(PUB, TWIST)], "cmd_vel: a publisher of geometry_msgs/msg/Twist, we subscribe to "
         "geometry_msgs/msg/TwistStamped"),
        ((PUB, TWIST), [(SUB, OTHER)], "cmd_vel: a subscriber of another definition of geometry_msgs/msg/Twist, "
         "RIHS01_0b0b0b0b…"),
        ((PUB, TWIST), [(SUB, STAMPED), (SUB, TWIST)], None),  # a second reader, such as RViz
        ((PUB, TWIST), [(PUB, STAMPED)], None),  # nobody listens yet
        ((PUB, TWIST), [(SUB, ELSEWHERE), (NODE, None)], None),
        ((PUB, TWIST), [], None),
    ],
)  # fmt: skip
def test_other_ends_of_another_type_are_named(ours, others, line):
    announced = [Announced(*ours[:1], "driver", ours[1]), *(Announced(kind, "base", what) for kind, what in others)]
    assert [str(each) for each in mismatches([ours], announced)] == ([line] if line else [])
