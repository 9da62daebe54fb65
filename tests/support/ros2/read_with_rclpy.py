"""Reads messages with ROS 2's own deserializer and writes them again: a line "TYPE HEX" in, the new HEX out."""

import importlib
import sys

from rclpy.serialization import deserialize_message, serialize_message

for line in sys.stdin:
    name, data = line.split()
    package, _, short = name.split("/")
    kind = getattr(importlib.import_module(f"{package}.msg"), short)
    message = deserialize_message(bytes.fromhex(data), kind)
    print(serialize_message(message).hex(), flush=True)
