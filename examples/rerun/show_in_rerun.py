"""Show a recording in rerun, in 3D. rerun reads transforms (tf) from a recording, but no markers: this adds them.

Needs rerun-sdk and mcap-ros2-support beside Tailor:

    tailor scene run.mcap                                # unless it was recorded by tailor up, which publishes scenes
    python examples/rerun/show_in_rerun.py run-scene.mcap out.rrd && rerun out.rrd
"""

import sys
from typing import Any

import numpy as np
import rerun as rr
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, TEXT = 0, 1, 2, 3, 4, 9  # visualization_msgs/msg/Marker


def main(recording: str, target: str) -> None:
    """Write `target` (.rrd) with the markers and frames of a recording."""
    rr.init("tailor")
    rr.save(target)
    rr.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    frames: dict[str, str] = {"map": "/map"}  # path of each frame
    with open(recording, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, value in reader.iter_decoded_messages():
            if schema is None:
                continue
            rr.set_time("time", timestamp=message.log_time * 1e-9)
            if schema.name == "tf2_msgs/msg/TFMessage":
                for each in value.transforms:
                    parent = frames.setdefault(each.header.frame_id, f"/{each.header.frame_id}")
                    frames[each.child_frame_id] = f"{parent}/{each.child_frame_id}"
                    rr.log(frames[each.child_frame_id], moved(each.transform.translation, each.transform.rotation))
            elif schema.name == "visualization_msgs/msg/MarkerArray" and "/sim/" not in channel.topic:
                for marker in value.markers:
                    path = f"{frames.get(marker.header.frame_id, '/map')}/{marker.ns.replace(' ', '_')}"
                    rr.log(path, moved(marker.pose.position, marker.pose.orientation), drawn(marker))


def moved(place: Any, turn: Any) -> rr.Transform3D:
    """Pose of a frame or a marker in its parent."""
    rotation = rr.Quaternion(xyzw=(turn.x, turn.y, turn.z, turn.w))
    return rr.Transform3D(translation=(place.x, place.y, place.z), quaternion=rotation)


def drawn(marker: Any) -> Any:
    """A marker as rerun's shape."""
    colour = [round(255 * part) for part in (marker.color.r, marker.color.g, marker.color.b, marker.color.a)]
    half = np.array((marker.scale.x, marker.scale.y, marker.scale.z)) / 2
    if marker.type == CUBE:
        return rr.Boxes3D(half_sizes=[half], colors=colour, fill_mode="solid")
    if marker.type == SPHERE:
        return rr.Ellipsoids3D(half_sizes=[half], colors=colour, fill_mode="solid")
    if marker.type == CYLINDER:
        return rr.Cylinders3D(lengths=[2 * half[2]], radii=[half[0]], colors=colour, fill_mode="solid")
    if marker.type == ARROW:
        return rr.Arrows3D(vectors=[(marker.scale.x, 0, 0)], radii=[half[1] / 2], colors=colour)
    if marker.type == LINE_STRIP:
        return rr.LineStrips3D([[(p.x, p.y, p.z) for p in marker.points]], radii=[half[0]], colors=colour)
    return rr.Points3D([(0, 0, 0)], labels=[marker.text], radii=[0.005], colors=colour, show_labels=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python show_in_rerun.py RECORDING.mcap TARGET.rrd")
    main(*sys.argv[1:])
