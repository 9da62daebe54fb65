"""Several machines: keys, mutual TLS, and what each key may do; all of it through the commands that people use."""

import subprocess
import time
from contextlib import ExitStack

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.rights.credentials import identity_in
from tailor.runtime.bus.session import opened
from tailor.runtime.processes.child import Child, tailor
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import EStop, VelocityCommand
from tests.support.bus_system import accepts, free_endpoint
from tests.support.patience import wait_until

pytestmark = pytest.mark.xdist_group("systems")
STEP_S = 0.3


def keys(folder, *words):
    return subprocess.run(tailor("keys", *words, "--keys", str(folder)), capture_output=True, text=True)


@pytest.fixture(scope="module")
def bus(tmp_path_factory):
    """`tailor bus --secure` with keys of an executive, a viewer and a revoked executive: (folder, local, remote)."""
    folder, local = tmp_path_factory.mktemp("bus") / "keys", free_endpoint()
    remote = free_endpoint().replace("tcp/127.0.0.1", "tls/127.0.0.1")
    assert keys(folder, "new", "router", "--host", "127.0.0.1").returncode == 0
    for name, role in (
        ("driving", "executive"),
        ("viewing", "observer"),
        ("former", "executive"),
        ("stopping", "people"),
    ):
        made = keys(folder, "new", name, "--role", role, "--for", remote)
        assert made.stdout == f"{folder / name}\n", made.stderr
    assert keys(folder, "revoke", "former").returncode == 0
    process = Child("bus", tailor("bus", "--connect", local, "--secure", remote, "--keys", str(folder)))
    try:
        wait_until(lambda: accepts(local) and accepts(remote.replace("tls/", "tcp/")), "gateways")
        yield folder, local, remote
    finally:
        process.stop()


def heard(bus, *, publisher):
    """Keys that a local recorder hears from a session."""
    _, local, _ = bus
    with open_client(local, role="recorder") as listener:
        queue, subscription = listener.subscribe_all("agilo/*")
        commands = publisher.publisher("cmd_vel", "agilo")
        time.sleep(STEP_S)  # both ends know of each other
        commands.publish(VelocityCommand(0, 0.5, 0.0))
        time.sleep(STEP_S)
        subscription.undeclare()
        return [raw.key for raw in queue.drain()]


@pytest.mark.promise("P16")
@pytest.mark.parametrize(("name", "keys"), [("driving", ["agilo/cmd_vel"]), ("viewing", []), ("former", [])])
def test_the_name_of_a_key_decides_what_it_may_publish(bus, name, keys):
    folder, _, remote = bus
    with open_client(remote, identity=identity_in(str(folder / name)), role="executive") as session:
        assert heard(bus, publisher=session) == keys


@pytest.mark.promise("P16")
def test_a_foreign_node_takes_the_one_file_that_was_written_for_it(bus):
    folder, _, _ = bus
    with opened((folder / "driving" / "session.json5").read_text()) as session:
        assert heard(bus, publisher=session) == ["agilo/cmd_vel"]


@pytest.mark.promise("P16")
def test_without_a_key_of_this_authority_no_session_opens(bus, tmp_path):
    _, _, remote = bus
    assert keys(tmp_path / "other", "new", "driving", "--role", "executive").returncode == 0
    for identity in (None, identity_in(str(tmp_path / "other" / "driving"))):
        with ExitStack() as stack, pytest.raises(UsageError, match="opens no session here"):
            stack.enter_context(open_client(remote, 0.7, identity=identity))


@pytest.mark.promise("P16")
def test_a_router_of_another_name_is_not_believed(tmp_path):
    """Whoever took the robot's address has no certificate for it."""
    folder, local = tmp_path / "keys", free_endpoint()
    remote = free_endpoint().replace("tcp/", "tls/")
    assert keys(folder, "new", "router", "--host", "other-robot").returncode == 0
    assert keys(folder, "new", "me", "--role", "people").returncode == 0
    process = Child("bus", tailor("bus", "--connect", local, "--secure", remote, "--keys", str(folder)))
    try:
        wait_until(lambda: accepts(remote.replace("tls/", "tcp/")), "gateway")
        with ExitStack() as stack, pytest.raises(UsageError, match="opens no session here"):
            stack.enter_context(open_client(remote, 0.7, identity=identity_in(str(folder / "me"))))
    finally:
        process.stop()


@pytest.mark.promise("P16")
def test_an_endpoint_for_people_alone_takes_no_other_key(bus):
    """The remote e-stop's own endpoint: a router of its own, which other traffic cannot delay."""
    folder, local, _ = bus
    listen = free_endpoint().replace("tcp/127.0.0.1", "tls/127.0.0.1")
    line = tailor("gateway", "--connect", local, "--listen", listen, "--keys", str(folder), "--only", "people")
    process = Child("gateway", line)
    try:
        wait_until(lambda: accepts(listen.replace("tls/", "tcp/")), "gateway")
        with open_client(local, role="observer") as listener:
            queue, subscription = listener.subscribe_all("**")
            for name in ("driving", "stopping"):
                with open_client(listen, identity=identity_in(str(folder / name))) as session:
                    commands, stops = session.publisher("cmd_vel", "agilo"), session.publisher("estop", "")
                    time.sleep(STEP_S)  # both ends know of each other
                    commands.publish(VelocityCommand(0, 0.5, 0.0))
                    stops.publish(EStop(True))
                    time.sleep(STEP_S)
            subscription.undeclare()
            assert [raw.key for raw in queue.drain() if raw.key in ("agilo/cmd_vel", "estop")] == ["estop"]
    finally:
        process.stop()


def test_an_estop_with_a_key_of_another_role_names_the_role_that_it_takes(bus):
    folder, _, remote = bus
    line = tailor("estop", "--connect", remote, "--key", str(folder / "driving"))
    done = subprocess.run(line, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr == f"{folder / 'driving'}: a key stops drivers only if its role is people (tailor keys list)\n"


WRONG = {
    "no name": (("new",), "name ''"),
    "no role": (("new", "x"), "--role"),
    "a role for the router": (("new", "router", "--role", "people"), "--role"),
    "a name that is a path": (("new", "../x", "--role", "people"), "name '../x'"),
    "a name twice": (("new", "x", "--role", "people"), "a key of it was made before"),
    "an unknown name": (("revoke", "y"), "no such key, expected one of: x"),
    "a bad endpoint": (("new", "z", "--role", "people", "--for", "nowhere"), "bus endpoint 'nowhere'"),
}


@pytest.mark.parametrize("mistake", WRONG)
def test_a_mistake_with_keys_is_one_line(tmp_path, mistake):
    words, line = WRONG[mistake]
    assert keys(tmp_path, "new", "x", "--role", "people").returncode == 0
    done = keys(tmp_path, *words)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert line in done.stderr


def test_keys_are_readable_by_their_user_alone(tmp_path):
    keys(tmp_path / "keys", "new", "x", "--role", "people")
    private = [*tmp_path.rglob("*key.pem")]
    assert len(private) == 2
    assert all(path.stat().st_mode & 0o077 == 0 for path in private)
