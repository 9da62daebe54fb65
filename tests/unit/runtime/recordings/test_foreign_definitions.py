"""Definitions as `ros2 bag record` writes them, from the files of ROS: other words for the same types."""

import time

import pytest
from mcap.writer import Writer

from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import LogLine, Odometry
from tailor.schemas.own import example
from tailor.schemas.typesystem import MAX_DEFINITION_CHARS, hash_of_definition, ros_type
from tailor.tools.main import main

LINE = "=" * 80 + "\nMSG: "
PARTS = {  # sorted, with names relative to their packages
    "builtin_interfaces/Time": "# from the epoch\nint32 sec\nuint32 nanosec\n",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation\n",
    "geometry_msgs/PoseWithCovariance": "Pose pose\n\n# row by row\nfloat64[36] covariance\n",
    "geometry_msgs/Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
    "geometry_msgs/Twist": "Vector3  linear\nVector3  angular\n",
    "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
}
ODOMETRY = """# An estimate
std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
""" + "".join(f"{LINE}{name}\n{text}" for name, text in PARTS.items())
LOG = f"""byte DEBUG=10
byte INFO=20
builtin_interfaces/Time stamp
uint8 level
string name
string msg
string file
string function
uint32 line
{LINE}builtin_interfaces/Time
int32 sec
uint32 nanosec
"""  # as in Humble, whose bags have /rosout


def bag(path, kind, text, defined="ros2msg", encoding="cdr"):
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="libmcap")
        schema = writer.register_schema(ros_type(kind), defined, text.encode())
        channel = writer.register_channel("/x", encoding, schema, {"offered_qos_profiles": ""})
        writer.add_message(channel, 5, encode(example(kind)), 5)
        writer.finish()
    return path


@pytest.mark.parametrize(("kind", "text"), [(Odometry, ODOMETRY), (LogLine, LOG)])
def test_a_bag_of_ros_2_is_read(tmp_path, kind, text):
    """It was refused: 'has changed since this was recorded'."""
    [(_, message)] = open_recording(bag(tmp_path / "a.mcap", kind, text)).decoded()
    assert message == example(kind)


@pytest.mark.parametrize(
    ("old", "new"), [("float64 z", "float32 z"), ("string child_frame_id\n", ""), ("Point position", "Pose position")]
)
def test_a_bag_whose_type_has_other_bytes_is_refused_by_name(tmp_path, old, new):
    path = bag(tmp_path / "a.mcap", Odometry, ODOMETRY.replace(old, new))
    with pytest.raises(UsageError, match="nav_msgs/msg/Odometry has changed"):
        list(open_recording(path).messages())


@pytest.mark.parametrize("text", ["x", "(" * 9000, "A a", "\n" * 10**7, "float64[99999999999999999999] x"])
def test_the_hash_of_any_text_is_found_soon(text):
    began_s = time.process_time()
    assert hash_of_definition("nav_msgs/msg/Odometry", text) != hash_of_definition("nav_msgs/msg/Odometry", ODOMETRY)
    assert time.process_time() - began_s < 2.0
    assert len(ODOMETRY) < MAX_DEFINITION_CHARS / 10


@pytest.mark.parametrize(("encoding", "defined"), [("json", "jsonschema"), ("protobuf", "protobuf")])
def test_a_message_of_another_encoding_is_none_of_ours_whatever_its_type_is_called(tmp_path, encoding, defined):
    """The whole file was refused, as if our type had changed: also by `tailor info` and `tailor cut`."""
    path = bag(tmp_path / "a.mcap", Odometry, "{}", defined, encoding)
    (recorded,) = open_recording(path).messages()
    assert recorded.value() is None
    assert list(open_recording(path).decoded()) == []
    assert main(["cut", str(path), "-o", str(tmp_path / "b.mcap"), "--topics", "nav_msgs/msg/Odometry"]) == 0


@pytest.mark.parametrize(("defined", "expected"), [("ros2idl", "is defined in 'ros2idl'"), ("", "is not defined")])
def test_a_definition_that_cannot_be_compared_is_called_so(tmp_path, defined, expected):
    with pytest.raises(UsageError, match=f"{ros_type(Odometry)} {expected}, expected its definition in 'ros2msg'"):
        list(open_recording(bag(tmp_path / "a.mcap", Odometry, "module x {};", defined)).messages())
