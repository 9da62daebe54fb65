"""Converts scenes to visualization_msgs/MarkerArray, tf2_msgs/TFMessage and rcl_interfaces/Log, and back."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from tailor.schemas import messages as m
from tailor.schemas.numbers import check_array, check_numbers
from tailor.schemas.ros_time import NS_PER_S, header, stamp_ns, time, time_ns
from tailor.schemas.typesystem import ros_class


@cache
def _class(name: str) -> Any:
    package, _, kind = name.partition("/")
    return ros_class(f"{package}/msg/{kind}")


def shapes_to_ros(message: m.SceneShapes) -> Any:
    """visualization_msgs/MarkerArray: one marker a shape, its name as the namespace."""
    return _class("visualization_msgs/MarkerArray")([_marker(shape, message.stamp_ns) for shape in message.shapes])


def shapes_from_ros(ros: Any) -> m.SceneShapes:
    """The shapes of a MarkerArray with the stamp of the first; deletions, colours by point and meshes are left out."""
    stamp = stamp_ns(ros.markers[0].header) if ros.markers else 0
    return m.SceneShapes(stamp, tuple(_shape(marker) for marker in ros.markers))


def transforms_to_ros(message: m.FrameTransforms) -> Any:
    """tf2_msgs/TFMessage."""
    return _class("tf2_msgs/TFMessage")([_transform(each, message.stamp_ns) for each in message.transforms])


def transforms_from_ros(ros: Any) -> m.FrameTransforms:
    """The transforms of a TFMessage with the stamp of the first."""
    stamp = stamp_ns(ros.transforms[0].header) if ros.transforms else 0
    return m.FrameTransforms(stamp, tuple(_frame(each) for each in ros.transforms))


def log_to_ros(message: m.LogLine) -> Any:
    """rcl_interfaces/Log without a place in the source."""
    stamp = time(message.stamp_ns)
    return _class("rcl_interfaces/Log")(
        stamp=stamp, level=message.level, name=message.name, msg=message.text, file="", function="", line=0
    )


def log_from_ros(ros: Any) -> m.LogLine:
    """The line of a Log."""
    return m.LogLine(time_ns(ros.stamp), ros.level, ros.name, ros.msg)


def _marker(shape: m.Shape, stamp: int) -> Any:
    position = _class("geometry_msgs/Point")(shape.x, shape.y, shape.z)
    turn = _class("geometry_msgs/Quaternion")(shape.qx, shape.qy, shape.qz, shape.qw)
    seconds, rest = divmod(round(shape.lifetime_s * NS_PER_S), NS_PER_S)
    return _class("visualization_msgs/Marker")(
        header=header(stamp, shape.frame),
        ns=shape.name,
        id=0,
        type=shape.kind,
        action=0,
        pose=_class("geometry_msgs/Pose")(position, turn),
        scale=_class("geometry_msgs/Vector3")(shape.length, shape.width, shape.height),
        color=_class("std_msgs/ColorRGBA")(shape.red, shape.green, shape.blue, shape.alpha),
        lifetime=_class("builtin_interfaces/Duration")(seconds, rest),
        frame_locked=False,
        points=_points(shape.points),
        colors=[],
        texture_resource="",
        texture=_class("sensor_msgs/CompressedImage")(header(0), "", np.zeros(0, np.uint8)),
        uv_coordinates=[],
        text=shape.text,
        mesh_resource="",
        mesh_file=_class("visualization_msgs/MeshFile")("", np.zeros(0, np.uint8)),
        mesh_use_embedded_materials=False,
    )


def _points(numbers: Sequence[float]) -> list[Any]:
    point = _class("geometry_msgs/Point")
    return [point(*numbers[i : i + 3]) for i in range(0, len(numbers) - 2, 3)]


def _shape(marker: Any) -> m.Shape:
    point, turn, scale, colour = marker.pose.position, marker.pose.orientation, marker.scale, marker.color
    place = (point.x, point.y, point.z, turn.x, turn.y, turn.z, turn.w)
    looks = (scale.x, scale.y, scale.z, colour.r, colour.g, colour.b, colour.a)
    line = [number for each in marker.points for number in (each.x, each.y, each.z)]
    check_numbers(*place, *looks)
    check_array(np.array(line))
    lifetime_s = marker.lifetime.sec + marker.lifetime.nanosec / NS_PER_S
    return m.Shape(
        marker.ns, marker.type, marker.header.frame_id, *place, *looks, lifetime_s, marker.text, points=tuple(line)
    )


def _transform(each: m.FrameTransform, stamp: int) -> Any:
    turn = _class("geometry_msgs/Quaternion")(each.qx, each.qy, each.qz, each.qw)
    moved = _class("geometry_msgs/Transform")(_class("geometry_msgs/Vector3")(each.x, each.y, each.z), turn)
    return _class("geometry_msgs/TransformStamped")(header(stamp, each.parent), each.child, moved)


def _frame(ros: Any) -> m.FrameTransform:
    moved, turn = ros.transform.translation, ros.transform.rotation
    place = (moved.x, moved.y, moved.z, turn.x, turn.y, turn.z, turn.w)
    check_numbers(*place)
    return m.FrameTransform(ros.header.frame_id, ros.child_frame_id, *place)


CONVERTERS: dict[type, tuple[Any, Any]] = {
    m.SceneShapes: (shapes_to_ros, shapes_from_ros),
    m.FrameTransforms: (transforms_to_ros, transforms_from_ros),
    m.LogLine: (log_to_ros, log_from_ros),
}
