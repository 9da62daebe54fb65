"""Definitions of all message types as ROS 2's tools read them: one folder a package, one file a type."""

from tailor.schemas.ros2 import interface_package
from tailor.schemas.ros2.action import STATES
from tailor.schemas.typesystem import definition, message_types, ros_type, typestore

LINE = "=" * 80


def write_definitions(folder):
    """Write the `.msg` files of every topic's type and of the types nested in it, and service and action of ours."""
    interface_package.write(folder / "tailor_msgs")
    whole = {ros_type(kind): definition(kind) for kind in message_types()}
    whole[STATES] = typestore().generate_msgdef(STATES, ros_version=2)[0]
    for own, of_parts in whole.items():
        head, *parts = of_parts.split(LINE + "\n")
        named = {own: head}
        for part in parts:
            title, _, body = part.partition("\n")
            package, _, short = title.removeprefix("MSG: ").strip().partition("/")
            named[f"{package}/msg/{short.removeprefix('msg/')}"] = body
        for name, text in named.items():
            path = folder / f"{name}.msg"
            path.parent.mkdir(parents=True, exist_ok=True)
            if not path.exists():
                path.write_text(text)
