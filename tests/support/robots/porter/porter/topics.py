"""Topics of the porter; their types are named as the files in porter_msgs/msg."""

from tailor.schemas.packages.topic import Topic

TOPICS = {
    "porter_rail": Topic("{robot}/rail", "RailCommand", 10, "executive", priority="real_time"),
    "porter_grip": Topic("{robot}/grip", "GripCommand", 10, "executive", priority="real_time"),
    "porter_state": Topic("{robot}/state", "PorterState", 20, "driver", 0.5),
    "porter_exact": Topic("{robot}/sim/exact", "PorterState", 10, "simulator"),
}
