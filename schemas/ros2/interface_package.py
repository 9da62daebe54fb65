"""The ROS 2 interface package `tailor_msgs`: a workspace builds it, and then knows our messages, service and action.

`python -m tailor.schemas.ros2.interface_package [FOLDER]` writes it; nothing of ours reads it. Comments come from the
dataclasses: the first line of the docstring, and the comment behind each field.
"""

from __future__ import annotations

import argparse
import inspect
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from tailor import __version__
from tailor.schemas.packages.msg_definitions import declarations
from tailor.schemas.packages.ros_names import PACKAGE, ros_type
from tailor.schemas.ros2 import action, service
from tailor.schemas.typesystem import own_types

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "ros2" / PACKAGE  # in the repository
FIELD = re.compile(r"^    (\w+): .*?  # (.+)$", re.MULTILINE)
MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>{version}</version>
  <description>Messages, service and action of the robot executive Tailor.</description>
  <maintainer email="tailor@example.org">The Tailor developers</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>action_msgs</depend>
  <depend>std_msgs</depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""
BUILD = """\
cmake_minimum_required(VERSION 3.20)
project({package})

find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package(action_msgs REQUIRED)
find_package(std_msgs REQUIRED)

rosidl_generate_interfaces(${{PROJECT_NAME}}
{files}
  DEPENDENCIES action_msgs std_msgs
)

ament_export_dependencies(rosidl_default_runtime)
ament_package()
"""


def msg_text(kind: type) -> str:
    """Content of the `.msg` file of a message type; reads the source of its dataclass."""
    comments = dict(FIELD.findall(inspect.getsource(kind)))
    lines = declarations(kind)
    width = max(map(len, lines.values()))
    first = (inspect.getdoc(kind) or "").partition("\n")[0]
    rows = [f"{line:<{width}}  # {comments[name]}" if name in comments else line for name, line in lines.items()]
    return "\n".join([f"# {first}", *rows, ""])


def msg_files() -> dict[str, str]:
    """Content of every `.msg` file by its name."""
    return {f"{k.__name__}.msg": msg_text(k) for k in own_types() if ros_type(k).startswith(f"{PACKAGE}/")}


def files() -> dict[str, str]:
    """Content of every file of the package, by its path in it."""
    interfaces = {f"msg/{name}": text for name, text in msg_files().items()}
    interfaces[f"srv/{service.SET_GOAL.rpartition('/')[2]}.srv"] = service.text()
    interfaces[f"action/{action.ACTION.rpartition('/')[2]}.action"] = action.text()
    listed = "\n".join(f'  "{path}"' for path in sorted(interfaces))
    return {
        "package.xml": MANIFEST.format(package=PACKAGE, version=__version__),
        "CMakeLists.txt": BUILD.format(package=PACKAGE, files=listed),
        **interfaces,
    }


def write(folder: Path = FOLDER) -> None:
    """Write all files and remove those whose type no longer exists."""
    content = files()
    for path in (*folder.glob("msg/*.msg"), *folder.glob("srv/*.srv"), *folder.glob("action/*.action")):
        if path.relative_to(folder).as_posix() not in content:
            path.unlink()
    for name, text in content.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def _may_write(folder: Path) -> bool:
    """Whether a folder is empty, missing, or holds this package: messages of another one would be removed."""
    manifest = folder / "package.xml"
    if manifest.is_file():
        return f"<name>{PACKAGE}</name>" in manifest.read_text(encoding="utf-8", errors="replace")
    return not folder.is_dir() or next(folder.iterdir(), None) is None


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the package into the folder that the arguments name, or into the repository; exit code 0, or 2."""
    parser = argparse.ArgumentParser(prog="interface_package", description="Write the ROS 2 interface package.")
    parser.add_argument("folder", type=Path, nargs="?", help="default: that of the repository")
    folder = parser.parse_args(arguments).folder
    if folder is None and not (ROOT / "pyproject.toml").is_file():
        print(f"interface_package: {ROOT} is an installation, not the repository: expected a FOLDER", file=sys.stderr)
        return 2
    if folder is not None and not _may_write(folder):
        print(f"interface_package: {folder} holds other files, expected {PACKAGE} or none", file=sys.stderr)
        return 2
    try:
        write(folder or FOLDER)
    except OSError as error:
        where = f"{error.filename}: {error.strerror}"
        print(f"interface_package: {where}, expected a folder that can be written", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
