"""Finds the children of a launcher by the command that they run."""

from pathlib import Path


def child_pid(parent, name):
    """Process id of the child of `parent` that runs `tailor NAME`."""
    for line in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
        if f"tailor.tools.main\0{name}\0" in Path(f"/proc/{line}/cmdline").read_text():
            return int(line)
    raise LookupError(name)
