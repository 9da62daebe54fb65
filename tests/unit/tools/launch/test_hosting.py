"""Who may use a bus that is hosted: secured unless another choice is named, and an open one is reported."""

from itertools import repeat

import pytest

from tailor.runtime.bus.rights.run_folder import VARIABLE, run_folder
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.launch import hosting
from tailor.tools.launch.hosting import free_endpoint, gateways, hosted_bus, private_bus
from tailor.tools.main import main

S = 1_000_000_000


@pytest.fixture
def opened(monkeypatch):
    """(endpoint, secured) of each local router that would be opened."""
    opened = []

    class Router:
        def __init__(self, endpoint, secured, keys):
            opened.append((endpoint, secured))

        def __enter__(self):
            return "session", "folder"

        def __exit__(self, *error):
            pass

    monkeypatch.setattr(hosting, "open_local_router", Router)
    return opened


def test_an_open_bus_does_not_listen_for_other_machines(opened):
    settings = BusSettings(free_endpoint(), security="open", remote=free_endpoint().replace("tcp/", "tls/"))
    with pytest.raises(UsageError, match="expected a secured bus for other machines"), hosted_bus(settings, print):
        pass
    assert opened == []


@pytest.mark.parametrize(("security", "secured", "reports"), [("run", True, 0), ("local", True, 0), ("open", False, 1)])
def test_a_bus_is_secured_unless_it_is_named_open_and_then_that_is_reported(opened, security, secured, reports):
    settings, lines = BusSettings(free_endpoint(), security=security), []
    with hosted_bus(settings, lines.append) as session:
        assert session == "session"
    assert opened == [(settings.endpoint, secured)]
    assert lines == [f"the bus is open: whoever reaches {settings.endpoint} drives the robot"] * reports


def test_the_default_is_secured_on_loopback_and_closed_to_other_machines():
    settings = BusSettings()
    assert (settings.security, settings.endpoint, settings.remote) == ("run", "tcp/127.0.0.1:7447", "")


def test_a_local_bus_opens_no_port():
    assert gateways(BusSettings(security="local")) == []
    assert private_bus().security == "local"


def test_every_port_has_a_process_of_its_own_that_is_missed_when_it_is_silent():
    specs = gateways(BusSettings(remote="tls/0.0.0.0:7448", keys="k"))
    assert [(spec.name, spec.silence_ns, spec.restarts) for spec in specs] == [
        ("gateway", 5 * S, True),
        ("remote gateway", 5 * S, True),
    ]
    assert specs[0].argv[-3:] == ["gateway", "--connect", "tcp/127.0.0.1:7447"]
    assert specs[1].argv[-4:] == ["--listen", "tls/0.0.0.0:7448", "--keys", "k"]


def test_other_machines_are_let_in_with_tls_alone(opened):
    settings = BusSettings(free_endpoint(), remote=free_endpoint())
    with pytest.raises(UsageError, match="expected tls/HOST:PORT for other machines"), hosted_bus(settings, print):
        pass
    assert opened == []


@pytest.mark.parametrize("protocol", ["tls", "quic"])
@pytest.mark.parametrize("security", ["run", "open"])
def test_a_bus_whose_gateway_would_need_certificates_for_its_own_endpoint_is_refused(opened, protocol, security):
    """The gateway would end, and a robot drive without it."""
    settings = BusSettings(free_endpoint().replace("tcp/", f"{protocol}/"), security=security)
    with pytest.raises(UsageError, match=f"endpoint {protocol}/.* expected tcp/HOST:PORT"), hosted_bus(settings, print):
        pass
    assert opened == []


def test_the_endpoint_of_a_bus_without_a_port_is_but_a_name(opened):
    with hosted_bus(BusSettings("tls/127.0.0.1:7447", security="local"), print):
        assert opened == [("tls/127.0.0.1:7447", True)]


def test_a_key_of_another_machine_is_refused_where_the_bus_runs(opened):
    with pytest.raises(UsageError, match="key operator: of a bus on another machine"):
        hosted_bus(BusSettings(free_endpoint(), key="operator"), print).__enter__()
    assert opened == []


def test_keys_without_an_endpoint_for_other_machines_are_refused(opened, capsys):
    assert main(["bus", "--connect", free_endpoint(), "--keys", "robots"]) == 2
    assert "--keys robots: expected with --secure" in capsys.readouterr().err
    assert opened == []


class Probe:
    """A socket to which the system gives the next of some ports."""

    def __init__(self, ports):
        self.ports = ports

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def bind(self, address):
        self.address = (address[0], next(self.ports))

    def getsockname(self):
        return self.address


def test_a_name_with_the_folder_of_another_bus_is_not_free(monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    run_folder("tcp/127.0.0.1:40001").path.mkdir()
    ports = iter((40001, 40002))
    monkeypatch.setattr(hosting.socket, "socket", lambda: Probe(ports))
    assert free_endpoint() == "tcp/127.0.0.1:40002"


def test_where_every_name_is_taken_the_folder_is_told(monkeypatch, tmp_path):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    run_folder("tcp/127.0.0.1:40001").path.mkdir()
    monkeypatch.setattr(hosting.socket, "socket", lambda: Probe(repeat(40001)))
    with pytest.raises(UsageError, match=f"^{tmp_path}: has a bus for each of 1000 free ports"):
        free_endpoint()
