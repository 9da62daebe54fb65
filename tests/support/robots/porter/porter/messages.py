"""The types of the files in porter_msgs/msg."""

from importlib import resources

from tailor.schemas.packages.msg_reader import read_messages

TYPES = read_messages(resources.files(__package__) / "porter_msgs")
RailCommand, GripCommand, PorterState = (TYPES[name] for name in ("RailCommand", "GripCommand", "PorterState"))
