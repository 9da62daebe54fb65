"""Too few file descriptors are refused in one line that names how many are enough: zenoh's threads panic without."""

import os
import re
import resource
import subprocess

import pytest

from tailor.runtime import descriptors
from tailor.runtime.descriptors import require_descriptors
from tailor.runtime.processes.child import tailor
from tailor.schemas.errors import UsageError
from tailor.tools.launch.hosting import free_endpoint
from tests.support.bus_system import ROOT
from tests.support.patience import PATIENCE_S, first_line

pytestmark = pytest.mark.xdist_group("systems")
REFUSED = r"tailor \w+: this process may have {} files and connections open \(ulimit -n\), expected at least (\d+)\n"


def limited(descriptors, *arguments, **streams):
    """A tailor command that may open so many files."""
    command = ["sh", "-c", 'ulimit -n "$0"; exec "$@"', str(descriptors), *tailor(*arguments)]
    return subprocess.Popen(command, text=True, cwd=ROOT, **streams)


def least(*arguments):
    """The number that a command expects when it may open almost none."""
    process = limited(15, *arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    output, errors = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, output) == (2, "")
    return int(re.fullmatch(REFUSED.format(15), errors)[1])


def test_a_bus_and_a_client_work_with_as_many_descriptors_as_they_name():
    at = ("--connect", free_endpoint())
    bus = limited(least("bus", *at), "bus", *at, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        assert first_line(bus.stdout).startswith("routing at")
        status = ("status", "--json", *at)
        client = limited(least(*status), *status, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        output, errors = client.communicate(timeout=PATIENCE_S)
        assert errors == ""
        assert '"no driver"' in output
    finally:
        bus.terminate()
        _, errors = bus.communicate(timeout=PATIENCE_S)
    assert (bus.returncode, errors) == (0, "")


def test_a_system_needs_more_the_more_processes_it_has():
    up = ("up", "soccer", "--connect", free_endpoint())
    assert least(*up) == least(*up, "--no-scene") + 2


@pytest.fixture
def limit(monkeypatch):
    """Sets what the system grants; 0, 1, 2 and 251 are in use, and 3 lists them."""
    monkeypatch.setattr(os, "listdir", lambda _: ["0", "1", "2", "3", "251"])
    return lambda soft: monkeypatch.setattr(resource, "getrlimit", lambda _: (soft, soft))


@pytest.mark.parametrize(("soft", "taken"), [(20, 3), (300, 4)])
def test_as_many_as_are_free_below_the_limit_are_granted(limit, soft, taken):
    limit(soft)
    require_descriptors(soft - taken)
    with pytest.raises(UsageError, match=rf"may have {soft} files and .* expected at least {soft + 1}$"):
        require_descriptors(soft - taken + 1)


@pytest.mark.parametrize("unknown", ["no limit", "no list"])
def test_what_the_system_does_not_tell_is_no_fault(limit, monkeypatch, unknown):
    limit(resource.RLIM_INFINITY if unknown == "no limit" else 100)
    monkeypatch.setattr(descriptors, "_FOLDER", "/dev/fd" if unknown == "no limit" else "/no/such/folder")
    require_descriptors(100)
