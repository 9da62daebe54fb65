"""The `.msg` files of our own message types, for ROS 2 users; nothing of ours reads them.

`python -m tailor.schemas.msg_files` writes them. Comments come from the dataclass: its docstring's first line, and the
comment behind each field.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path

from tailor.schemas.msg_definitions import declarations
from tailor.schemas.packages.ros_names import PACKAGE, ros_type
from tailor.schemas.typesystem import own_types

FOLDER = Path(__file__).parent / "msg"
FIELD = re.compile(r"^    (\w+): .*?  # (.+)$", re.MULTILINE)


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


def write(folder: Path = FOLDER) -> None:
    """Write all files and remove those whose type no longer exists."""
    files = msg_files()
    for path in folder.glob("*.msg"):
        if path.name not in files:
            path.unlink()
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
