"""ROS 2's own generator reads the interface package, and hashes every type in it as we do.

Skipped without the extra `ros` (`pip install -e '.[ros]'`, Python 3.11).
"""

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tailor.schemas.ros2.action import ACTION, achieve_goal
from tailor.schemas.ros2.interface_package import files, write
from tailor.schemas.ros2.service import set_goal
from tailor.schemas.typesystem import hash_of
from tests.support.ros2.in_ros import environment

pytestmark = pytest.mark.skipif(
    not all(map(find_spec, ("rosidl_cli", "catkin_pkg"))), reason="no rosidl: pip install -e '.[ros]' (Python 3.11)"
)
DEPENDENCIES = ("action_msgs", "builtin_interfaces", "service_msgs", "std_msgs", "unique_identifier_msgs")
SHARE = Path(sys.prefix) / "share"


def test_ros_hashes_every_type_of_the_package_as_we_do(tmp_path):
    package, out = tmp_path / "tailor_msgs", tmp_path / "out"
    write(package)
    interfaces = [name for name in files() if name.endswith((".msg", ".srv", ".action"))]
    includes = [word for each in DEPENDENCIES for word in ("-I", SHARE / each)]
    command = [Path(sys.prefix) / "bin" / "rosidl", "hash", "-o", out, *includes, package.name, *interfaces]
    subprocess.run(command, cwd=package, env=environment(), check=True, capture_output=True)
    stated = [json.loads(path.read_text())["type_hashes"][0] for path in out.glob("*/*.json")]
    theirs = {row["type_name"]: row["hash_string"] for row in stated}
    del theirs[ACTION]  # of the action as a whole, which no key contains
    parts = achieve_goal()
    assert {set_goal().type, parts.send_goal.type, parts.get_result.type, parts.feedback.type} <= set(theirs)
    assert {name: hash_of(name) for name in theirs} == theirs
