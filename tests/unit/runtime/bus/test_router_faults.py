"""A key that does not believe the router at an address tells why: the router is of another name or authority."""

import socket
import ssl
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from threading import Thread

import pytest

from tailor.runtime.bus import opening
from tailor.runtime.bus.rights.credentials import Identity
from tailor.runtime.bus.rights.router_faults import fault_of_router
from tailor.runtime.bus.session import CannotOpenError
from tailor.tools.keys.authority import Authority
from tailor.tools.main import main

NOW = datetime.now(UTC)
LIMIT_S = 5.0


@pytest.fixture
def keys(tmp_path):
    """Keys of one authority, the router's for another host among them, and a router's of another authority."""
    for folder in ("keys", "others"):
        authority = Authority.of(tmp_path / folder, NOW, 10)
        authority.issue(tmp_path / folder / "router", "router", ("127.0.0.1",), NOW, 10)
    authority = Authority.of(tmp_path / "keys", NOW, 10)
    authority.issue(tmp_path / "keys" / "elsewhere", "elsewhere", ("robot.local", "10.0.0.5"), NOW, 10)
    authority.issue(tmp_path / "keys" / "ann", "ann", (), NOW, 10)
    return tmp_path


@contextmanager
def answering(folder):
    """Port at which a router answers with the key of a folder."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(folder / "certificate.pem", folder / "key.pem")
    context.load_verify_locations(folder / "authority.pem")
    context.verify_mode = ssl.CERT_REQUIRED

    def answer():
        while True:
            try:
                connection, _ = listener.accept()
            except OSError:
                return
            with suppress(OSError), connection, context.wrap_socket(connection, server_side=True) as session:
                session.recv(1)

    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = Thread(target=answer)
        thread.start()
        yield listener.getsockname()[1]
        listener.shutdown(socket.SHUT_RDWR)
    thread.join()


@pytest.mark.parametrize(
    ("router", "fault"),
    [
        ("keys/router", ""),
        ("keys/elsewhere", "the certificate there is not for 127.0.0.1, expected one of the names or addresses that "),
        ("others/router", "the certificate there is not of {}/keys/ann/authority.pem: "),
    ],
)
def test_the_certificate_of_a_router_is_judged(keys, router, fault):
    with answering(keys / router) as port:
        found = fault_of_router(Identity(keys / "keys" / "ann"), "127.0.0.1", port, LIMIT_S)
    assert found.startswith(fault.format(keys))
    assert bool(found) == bool(fault)


def test_a_program_that_speaks_no_tls_has_no_certificate_to_judge(keys):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        assert fault_of_router(Identity(keys / "keys" / "ann"), "127.0.0.1", listener.getsockname()[1], 0.05) == ""


def test_a_command_names_the_router_that_was_made_for_another_host(keys, monkeypatch, capsys):
    """It told that the bus belongs to another user, or that this one has no key: `--host` was forgotten there."""

    def refuse(*_):
        raise CannotOpenError("no session")

    monkeypatch.setattr(opening, "opened", refuse)
    with answering(keys / "keys" / "elsewhere") as port:
        words = ["--connect", f"tls/127.0.0.1:{port}", "--key", str(keys / "keys" / "ann")]
        assert main(["estop", *words]) == 2
    error = capsys.readouterr().err
    assert f"tls/127.0.0.1:{port}: it opens no session here: the certificate there is not for 127.0.0.1" in error
    assert "`tailor keys new router --host …`" in error
    assert error.count("\n") == 1
