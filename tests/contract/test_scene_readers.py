"""Markers, transforms and log of a recording are read by readers that share no line with ours, from the file alone."""

import math
import shutil
import subprocess
import sys
from collections import Counter
from importlib.util import find_spec
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from tailor.tools.scenes.recorded_scenes import add_scenes

GOLDEN = Path(__file__).resolve().parents[1] / "data" / "golden"
CUBE, SPHERE, CYLINDER, LINE_STRIP, TEXT = 1, 2, 3, 4, 9  # of visualization_msgs/msg/Marker
RERUN = shutil.which("rerun")


@pytest.fixture(scope="module")
def soccer(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "soccer.mcap"
    added, feed, _ = add_scenes(GOLDEN / "soccer-approach-dribble.mcap", path)
    assert added > 150
    assert not feed.fault
    return path


@pytest.fixture(scope="module")
def read(soccer):
    """Messages by topic, as rosbags reads them with the definitions in the file."""
    found = {}
    with AnyReader([soccer]) as reader:
        for connection, _, raw in reader.messages():
            if connection.msgtype.startswith(("visualization_msgs", "tf2_msgs", "rcl_interfaces")):
                found.setdefault(connection.topic, []).append(reader.deserialize(raw, connection.msgtype))
    return found


def test_robot_ball_field_subgoals_and_way_are_markers(read):
    last = {marker.ns: marker for marker in read["/agilo/scene"][-2].markers}
    types = {"chassis": CUBE, "ball": SPHERE, "left wheel": CYLINDER, "field": LINE_STRIP, "way": LINE_STRIP}
    types["doing"] = TEXT
    assert {name: last[name].type for name in types} == types
    assert any(name.startswith("subgoal ") for name in last)
    assert last["chassis"].header.frame_id == "base_link"
    assert last["ball"].header.frame_id == "map"
    assert (last["ball"].scale.x, last["ball"].color.a) == pytest.approx((0.22, 1.0))
    assert len(last["way"].points) > 100
    ids = Counter((marker.ns, marker.id) for marker in read["/agilo/scene"][-2].markers)
    assert set(ids.values()) == {1}, "viewers take markers with equal namespace and id for one"


def test_transforms_lead_from_map_over_odom_to_base_link(read):
    for message in read["/tf"]:
        assert [(each.header.frame_id, each.child_frame_id) for each in message.transforms] == [
            ("map", "odom"),
            ("odom", "base_link"),
        ]
        for each in message.transforms:
            turn = each.transform.rotation
            assert math.hypot(turn.x, turn.y, turn.z, turn.w) == pytest.approx(1.0)


def test_stamps_of_markers_are_those_of_a_transform(read):
    stamps = {(m.header.stamp.sec, m.header.stamp.nanosec) for each in read["/tf"] for m in each.transforms}
    drawn = {(m.header.stamp.sec, m.header.stamp.nanosec) for each in read["/agilo/scene"] for m in each.markers}
    assert drawn <= stamps, "else a viewer must guess where base_link was"


def test_mcap_ros2_support_reads_the_same_markers(soccer, read):
    with soccer.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        decoded = [value for *_, value in reader.iter_decoded_messages(topics=["/agilo/scene"])]
    assert len(decoded) == len(read["/agilo/scene"])
    for one, other in zip(decoded, read["/agilo/scene"], strict=True):
        assert [(m.ns, m.type, m.pose.position.x) for m in one.markers] == [
            (m.ns, m.type, m.pose.position.x) for m in other.markers
        ]


def test_the_log_tells_the_run(read):
    lines = [line.msg for line in read["/rosout"]]
    assert any(line.startswith("approachBall begins") for line in lines)
    assert lines[-1] == "achieved"


def test_everything_else_is_copied_byte_for_byte(soccer, tmp_path):
    def rows(path):
        with path.open("rb") as file:
            return [
                (channel.topic, message.log_time, message.sequence, message.data)
                for schema, channel, message in make_reader(file).iter_messages(log_time_order=False)
                if not schema.name.startswith(("visualization_msgs", "tf2_msgs", "rcl_interfaces"))
            ]

    assert rows(soccer) == rows(GOLDEN / "soccer-approach-dribble.mcap")
    again = tmp_path / "again.mcap"
    add_scenes(soccer, again)
    assert again.read_bytes() == soccer.read_bytes(), "markers are replaced, not doubled"


@pytest.mark.skipif(RERUN is None, reason="no rerun here: pip install rerun-sdk")
def test_reruns_own_converter_makes_moving_frames_of_the_transforms(soccer, tmp_path):
    target = tmp_path / "soccer.rrd"
    subprocess.run([RERUN, "mcap", "convert", soccer, "-o", target], check=True, capture_output=True, timeout=120)
    printed = subprocess.run([RERUN, "rrd", "print", target], check=True, capture_output=True, text=True, timeout=120)
    assert "Transform3D:child_frame" in printed.stdout


@pytest.mark.skipif(find_spec("rerun") is None, reason="no rerun here: pip install rerun-sdk")
def test_the_example_shows_the_markers_in_rerun(soccer, tmp_path):
    script, target = GOLDEN.parents[2] / "examples" / "rerun" / "show_in_rerun.py", tmp_path / "shown.rrd"
    subprocess.run([sys.executable, script, soccer, target], check=True, capture_output=True, timeout=120)
    assert target.stat().st_size > 50_000
