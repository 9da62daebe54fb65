"""A bus on a free loopback port, with child processes that end with the test."""

import sys
import time
from contextlib import contextmanager
from pathlib import Path

from runtime.processes import Child
from runtime.session import open_router
from tools.system import free_endpoint

ROOT = Path(__file__).resolve().parents[2]


@contextmanager
def bus_system():
    """Yields (router session, endpoint, start), where start(module, *arguments) runs one of our modules."""
    endpoint, children = free_endpoint(), []

    def start(module, *arguments):
        children.append(Child(module, [sys.executable, "-m", module, *map(str, arguments)]))
        return children[-1]

    with open_router(endpoint) as session:
        try:
            yield session, endpoint, start
        finally:
            for child in children:
                child.kill()


def wait_until(condition, timeout_s=10.0, what="condition"):
    """Poll; fails the test after `timeout_s`."""
    ends = time.monotonic() + timeout_s
    while time.monotonic() < ends:
        if found := condition():
            return found
        time.sleep(0.005)
    raise AssertionError(f"{what}: not within {timeout_s} s")
