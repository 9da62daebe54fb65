"""Topics of the truck, with types from its .msg files."""

from importlib import resources

from tailor.schemas.packages.msg_reader import read_messages
from tailor.schemas.packages.topic import Topic

TYPES = read_messages(resources.files(__package__) / "truck_msgs")
TruckCommand, TruckState = TYPES["TruckCommand"], TYPES["TruckState"]
TOPICS = {
    "truck_axes": Topic("{robot}/axes", TruckCommand, 10, "executive", priority="real_time"),
    "truck_tags": Topic("{robot}/tags", TruckState, 20, "driver", 0.5),
    "truck_exact": Topic("{robot}/sim/exact", TruckState, 10, "simulator"),
}
