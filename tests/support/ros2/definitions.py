"""Definitions of all message types as ROS 2's tools read them: one folder a package, one file a type."""

from tailor.schemas.ros2 import interface_package
from tailor.schemas.typesystem import definition, message_types, ros_type

LINE = "=" * 80


def write_definitions(folder):
    """Write the `.msg` files of every topic's type and of the types nested in it, and the service of ours."""
    interface_package.write(folder / "tailor_msgs")
    for kind in message_types():
        head, *parts = definition(kind).split(LINE + "\n")
        named = {ros_type(kind): head}
        for part in parts:
            name, _, text = part.partition("\n")
            package, _, short = name.removeprefix("MSG: ").strip().partition("/")
            named[f"{package}/msg/{short.removeprefix('msg/')}"] = text
        for name, text in named.items():
            path = folder / f"{name}.msg"
            path.parent.mkdir(parents=True, exist_ok=True)
            if not path.exists():
                path.write_text(text)
