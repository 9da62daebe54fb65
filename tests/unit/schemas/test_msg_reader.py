"""Messages of a ROS 2 interface package become types like ours; a file that cannot be read is named with its line."""

from pathlib import Path

import pytest

from tailor.schemas.packages.msg_definitions import declarations
from tailor.schemas.packages.msg_reader import read_messages
from tailor.schemas.packages.ros_names import ros_type

ARM = """# A gripper
std_msgs/Header header
float64 width  # m

Finger[] fingers
string[] names
bool closed
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "grip_msgs" / "msg").mkdir(parents=True)
    return tmp_path / "grip_msgs"


def test_a_type_has_the_fields_of_its_file(folder: Path) -> None:
    (folder / "msg" / "Gripper.msg").write_text(ARM)
    (folder / "msg" / "Finger.msg").write_text("int64 number\nfloat64[] angles\n")
    types = read_messages(folder, "base_link")
    assert set(types) == {"Gripper", "Finger"}
    assert ros_type(types["Gripper"]) == "grip_msgs/msg/Gripper"
    assert types["Gripper"].FRAME_ID == "base_link"
    assert list(declarations(types["Gripper"]).values()) == [
        "std_msgs/Header header",
        "float64 width",
        "grip_msgs/Finger[] fingers",
        "string[] names",
        "bool closed",
    ]
    assert read_messages(folder, "base_link")["Gripper"] is types["Gripper"], "modules that read it apart agree"
    one = types["Gripper"](7, 0.1, (types["Finger"](1, (0.5,)),), ("a",), True)
    assert (one.stamp_ns, one.width, one.fingers[0].angles) == (7, 0.1, (0.5,))
    assert one == types["Gripper"](7, 0.1, (types["Finger"](1, (0.5,)),), ("a",), True)


@pytest.mark.parametrize(
    "line",
    [
        *(
            "float32 x",
            "float64",
            "float64 x y",
            "float64[3] x",
            "Nothing[] x",
            "float64 2x",
            "uint8 A=1",
            "Gripper[] own",
        ),
        *("float64 class", "float64 width", "int64 stamp_ns", "string ROS_TYPE", "float64[][] x"),
    ],
)
def test_a_line_that_no_field_can_be_is_named(folder: Path, line: str) -> None:
    (folder / "msg" / "Gripper.msg").write_text(f"float64 width\n{line}  # text\n")
    with pytest.raises(ValueError, match=r"Gripper.msg, line 2: .* expected a new NAME after one of: int64"):
        read_messages(folder)


def test_a_header_comes_first(folder: Path) -> None:
    (folder / "msg" / "Gripper.msg").write_text("float64 width\nstd_msgs/Header header\n")
    with pytest.raises(ValueError, match="line 2"):
        read_messages(folder)


def test_a_folder_without_messages_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"no \.msg file"):
        read_messages(tmp_path / "none_msgs")
