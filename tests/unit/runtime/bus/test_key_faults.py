"""A key that opens no session is named, with what is wrong with it: damaged, mixed up, or out of date."""

import shutil
import socket
from datetime import UTC, datetime, timedelta

import pytest

from tailor.runtime.bus import opening
from tailor.runtime.bus.rights.credentials import Identity
from tailor.runtime.bus.rights.key_faults import check_files, out_of_date
from tailor.runtime.bus.rights.run_folder import RunFolder
from tailor.runtime.bus.session import CannotOpenError
from tailor.schemas.errors import UsageError
from tailor.simnodes.hardware.plain_settings import RobotBus
from tailor.simnodes.hardware.robots_bus import robots_session
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.keys.authority import Authority
from tailor.tools.launch import hosting
from tailor.tools.main import main
from tests.support.bus_system import free_endpoint

NOW = datetime.now(UTC)


@pytest.fixture
def keys(tmp_path):
    """Keys of a router and of two people, valid for ten days, and one of another authority."""
    for folder, names in (("keys", ("router", "ann", "bob")), ("others", ("eve",))):
        authority = Authority.of(tmp_path / folder, NOW, 10)
        for name in names:
            authority.issue(tmp_path / folder / name, name, ("127.0.0.1",), NOW, 10)
    (tmp_path / "keys" / "roles.json").write_text('{"ann": "people", "bob": "people"}')
    return tmp_path / "keys"


def emptied(folder):
    (folder / "key.pem").write_text("")


def with_other_key(folder):
    shutil.copy(folder.parent / "bob" / "key.pem", folder)


def with_other_authority(folder):
    shutil.copy(folder.parent.parent / "others" / "authority.pem", folder)


def garbled(folder):
    (folder / "certificate.pem").write_bytes(bytes(range(256)))


DAMAGE = [
    (emptied, "key.pem: is no private key"),
    (with_other_key, "key.pem: is not the key of certificate.pem"),
    (with_other_authority, "certificate.pem: is not of authority.pem there"),
    (garbled, "certificate.pem: is no certificate"),
]


def expired(folder):
    shutil.rmtree(folder)
    authority = Authority.of(folder.parent, NOW, 10)
    authority.issue(folder, folder.name, ("127.0.0.1",), NOW - timedelta(days=30), 10)


@pytest.fixture
def refusing(monkeypatch):
    """Endpoint at which something listens that opens no session."""

    def refuse(*_):
        raise CannotOpenError("no session")

    monkeypatch.setattr(opening, "opened", refuse)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield f"tls/127.0.0.1:{listener.getsockname()[1]}"


def test_a_good_key_has_no_fault(keys):
    for name in ("router", "ann"):
        check_files(Identity(keys / name))
        assert out_of_date(Identity(keys / name)) == ""


@pytest.mark.parametrize(("days", "fault"), [(11, "has expired on "), (-2, "is valid from ")])
def test_the_time_of_a_key_is_judged_by_the_clock_of_the_machine(keys, days, fault):
    assert fault in out_of_date(Identity(keys / "ann"), NOW + timedelta(days=days))


@pytest.mark.parametrize(("damage", "fault"), [*DAMAGE, (expired, "certificate.pem: has expired on ")])
def test_a_command_whose_key_opens_no_session_names_what_is_wrong(keys, refusing, capsys, damage, fault):
    """It told that the bus belongs to another user, or that this one has no key."""
    damage(keys / "ann")
    assert main(["estop", "--connect", refusing, "--key", str(keys / "ann")]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"tailor estop: {keys / 'ann'}/{fault}")
    assert error.count("\n") == 1


def test_a_driver_whose_key_opens_no_session_of_the_robots_bus_names_it(keys, refusing):
    emptied(keys / "ann")
    bus = RobotBus(connect=refusing, key=str(keys / "ann"))
    with pytest.raises(ConnectionError, match=r"opens no session, since .*key\.pem"), robots_session(bus, bus.connect):
        pass


@pytest.mark.parametrize(("damage", "fault"), DAMAGE)
def test_a_bus_does_not_start_with_a_damaged_key(keys, damage, fault):
    """Its gateway ended, since it `cannot listen there; expected a free one`."""
    damage(keys / "router")
    settings = BusSettings(free_endpoint(), remote=free_endpoint().replace("tcp", "tls"), keys=str(keys))
    with pytest.raises(UsageError, match=fault), hosting.hosted_bus(settings, print):
        pass


def test_a_bus_with_a_key_that_is_out_of_date_starts_and_says_who_is_shut_out(keys):
    """The clock may be what is wrong, and this machine's own processes need no key."""
    expired(keys / "router")
    settings, lines = BusSettings(free_endpoint(), remote=free_endpoint().replace("tcp", "tls"), keys=str(keys)), []
    with hosting.hosted_bus(settings, lines.append):
        pass
    assert len(lines) == 1
    assert "certificate.pem: has expired on " in lines[0]
    assert lines[0].endswith(": no other machine opens a session")


def test_a_gateway_of_its_own_refuses_a_damaged_key_as_well(keys, monkeypatch, capsys):
    garbled(keys / "router")
    monkeypatch.setattr(RunFolder, "running", lambda _: True)
    words = ["gateway", "--listen", "tls/127.0.0.1:9", "--keys", str(keys), "--connect", free_endpoint()]
    assert main(words) == 2
    assert "certificate.pem: is no certificate" in capsys.readouterr().err
