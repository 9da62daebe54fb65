"""What protects a router and its clients, value by value: a configuration that is merely accepted protects nothing."""

import json
from base64 import b64decode
from pathlib import Path

import pytest

from tailor.runtime.bus import zenoh_config
from tailor.runtime.bus.rights import access
from tailor.runtime.bus.rights.credentials import Identity, Password
from tailor.runtime.bus.rights.run_folder import RunFolder
from tailor.schemas.errors import UsageError
from tailor.schemas.packages.package_topics import PRIORITIES
from tailor.schemas.services import ROLES

ENDPOINT = "tcp/127.0.0.1:7999"
ROUTER = json.loads(zenoh_config.router(ENDPOINT))
CLIENT = json.loads(zenoh_config.client([ENDPOINT]))
IDENTITY = Identity(Path("/keys"))
NAMES = {"tablet": "people", "arm": "driver", "phone": "people"}


@pytest.fixture
def folder(tmp_path):
    """Of a bus with passwords."""
    folder = RunFolder(tmp_path)
    folder.users_file.write_text("".join(f"{user}:{user[::-1]}\n" for user in (*ROLES, access.GATEWAY)))
    return folder


def test_nothing_beyond_this_machine_is_reached_by_default():
    assert zenoh_config.DEFAULT_ENDPOINT == "tcp/127.0.0.1:7447"


@pytest.mark.parametrize(
    "endpoint",
    ["tcp/a..b:7447", "tcp/.a:7447", f"tcp/{'a' * 64}:7447", "tcp/-:0", f"tcp/[{'0' * 64}]:7447", "tcp/a:65536"],
)
def test_an_endpoint_at_which_no_host_can_be_is_refused(endpoint):
    """Python raises an error of Unicode for a name with an empty part, where it is looked up."""
    with pytest.raises(UsageError, match="expected PROTOCOL/HOST:PORT"):
        zenoh_config.check_endpoint(endpoint)


@pytest.mark.parametrize("host", ["localhost", "robot-3.example.org", "robot.", "10.0.0.7", "[::1]", "a" * 63])
def test_an_endpoint_has_a_host_of_any_name(host):
    assert zenoh_config.check_endpoint(f"tls/{host}:7448") == f"tls/{host}:7448"


def test_no_session_looks_for_others_or_lets_itself_be_found():
    for config in (ROUTER, CLIENT):
        assert config["scouting"] == {"multicast": {"enabled": False}, "gossip": {"enabled": False}}


def test_a_router_listens_at_its_endpoint_alone_and_a_client_nowhere():
    assert (ROUTER["mode"], ROUTER["listen"]["endpoints"], ROUTER["connect"]["endpoints"]) == ("router", [ENDPOINT], [])
    assert (CLIENT["mode"], CLIENT["listen"]["endpoints"], CLIENT["connect"]["endpoints"]) == ("client", [], [ENDPOINT])


def test_no_message_goes_around_the_limits_of_size_through_shared_memory():
    for config in (ROUTER, CLIENT):
        assert config["transport"]["shared_memory"] == {"enabled": False}


def test_a_peer_that_is_silent_for_a_second_is_gone_and_a_burst_keeps_its_tail():
    for config in (ROUTER, CLIENT):
        link = config["transport"]["link"]["tx"]
        assert link["lease"] == 1000
        assert link["queue"]["size"] == dict.fromkeys(("control", *PRIORITIES), 16)
        assert link["queue"]["allocation"] == {"mode": "init"}, "else memory grows with each backlog"


def test_connections_that_send_nothing_are_many_and_soon_closed(folder):
    routers = (zenoh_config.local_router(folder), zenoh_config.gateway(ENDPOINT, folder, None, {}))
    for config in (ROUTER, *map(json.loads, routers)):
        assert config["transport"]["unicast"] == {"accept_pending": 2000, "accept_timeout": 1000}


def test_a_client_is_back_within_a_second_and_storms_nobody():
    retry = CLIENT["connect"]["retry"]
    assert retry == {"period_init_ms": 200, "period_max_ms": 200, "period_increase_factor": 1}


def test_every_router_limits_the_rate_of_e_stops(folder):
    gateway = json.loads(zenoh_config.gateway(ENDPOINT, folder, None, {}))
    local = json.loads(zenoh_config.local_router(folder))
    assert ROUTER["downsampling"] == gateway["downsampling"] == access.rate_limits(1000.0)
    assert local["downsampling"] == access.rate_limits(5000.0), "of all peers of the gateway together"


def test_no_router_waits_for_a_subscriber(folder):
    routers = (zenoh_config.local_router(folder), zenoh_config.gateway(ENDPOINT, folder, None, {}))
    for config in (ROUTER, *map(json.loads, routers)):
        (rule,) = config["qos"]["network"]
        assert (rule["key_exprs"], rule["flows"]) == (["**"], ["ingress"])
        assert rule["overwrite"] == {"congestion_control": "drop"}
        assert {"put", "delete", "query"} == set(rule["messages"]), "all that may block by the choice of who sends it"


def test_the_local_router_demands_passwords_and_applies_the_rules(folder):
    config = json.loads(zenoh_config.local_router(folder))
    subjects = [{"id": user, "usernames": [user]} for user in (*ROLES, access.GATEWAY)]
    assert config["listen"]["endpoints"] == [f"unixsock-stream/{folder.path}/bus.sock"]
    assert config["transport"]["auth"] == {"usrpwd": {"dictionary_file": str(folder.users_file)}}
    assert config["access_control"] == access.access_control(subjects)
    assert config["low_pass_filter"] == access.size_limits()


def test_an_open_local_router_has_neither(tmp_path):
    config = json.loads(zenoh_config.local_router(RunFolder(tmp_path)))
    assert config.keys() & {"access_control", "low_pass_filter"} == set()
    assert "auth" not in config["transport"]


def test_the_gateway_demands_passwords_and_trusts_the_local_router_by_its_socket_alone(folder):
    config = json.loads(zenoh_config.gateway(ENDPOINT, folder, None, {}))
    subjects = [*({"id": role, "usernames": [role]} for role in ROLES)]
    subjects += [{"id": access.GATEWAY, "link_protocols": ["unixsock-stream"]}]
    assert config["transport"]["auth"]["usrpwd"] == {
        "user": "gateway", "password": "yawetag", "dictionary_file": str(folder.users_file),
    }  # fmt: skip
    assert config["access_control"] == access.access_control(subjects)
    assert config["low_pass_filter"] == access.size_limits()
    assert config["connect"]["endpoints"] == [folder.socket_endpoint]


def test_a_gateway_with_certificates_takes_roles_from_their_names_and_nobody_without_one(folder):
    config = json.loads(zenoh_config.gateway("tls/host:7447", folder, IDENTITY, NAMES))
    assert config["access_control"]["subjects"] == [
        {"id": "driver", "cert_common_names": ["arm"]},
        {"id": "people", "cert_common_names": ["phone", "tablet"]},
        {"id": access.GATEWAY, "link_protocols": ["unixsock-stream"]},
    ]
    assert config["transport"]["auth"]["usrpwd"]["dictionary_file"] == str(folder.certificate_users_file)
    assert config["transport"]["link"]["tls"] == {
        "root_ca_certificate": "/keys/authority.pem",
        "enable_mtls": True,
        "listen_private_key": "/keys/key.pem",
        "listen_certificate": "/keys/certificate.pem",
        "connect_private_key": "/keys/key.pem",
        "connect_certificate": "/keys/certificate.pem",
    }


@pytest.mark.parametrize("identity", [None, IDENTITY])
def test_a_gateway_for_one_role_knows_no_other(folder, identity):
    config = json.loads(zenoh_config.gateway("tls/host:7447", folder, identity, NAMES, ["people"]))
    known = {"usernames": ["people"]} if identity is None else {"cert_common_names": ["phone", "tablet"]}
    assert config["access_control"]["subjects"] == [
        {"id": "people", **known},
        {"id": access.GATEWAY, "link_protocols": ["unixsock-stream"]},
    ]


def test_a_client_proves_itself_with_the_password_of_its_role():
    config = json.loads(zenoh_config.client([ENDPOINT], password=Password("people", "x")))
    assert config["transport"]["auth"] == {"usrpwd": {"user": "people", "password": "x"}}


def test_a_client_with_a_certificate_checks_the_name_of_its_router():
    tls = json.loads(zenoh_config.client([ENDPOINT], identity=IDENTITY))["transport"]["link"]["tls"]
    assert (tls["enable_mtls"], tls["verify_name_on_connect"]) == (True, True)
    assert tls["connect_private_key"] == "/keys/key.pem"


def test_so_does_a_node_that_is_not_ours(tmp_path):
    for name in ("authority.pem", "certificate.pem", "key.pem"):
        (tmp_path / name).write_text(name)
    config = json.loads(zenoh_config.foreign_client("tls/host:7447", tmp_path))
    tls = config["transport"]["link"]["tls"]
    assert (tls["enable_mtls"], tls["verify_name_on_connect"]) == (True, True)
    assert b64decode(tls["connect_private_key_base64"]) == b"key.pem"
    assert (config["listen"]["endpoints"], config["connect"]["endpoints"]) == ([], ["tls/host:7447"])
