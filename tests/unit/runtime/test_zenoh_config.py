"""What protects a router and its clients, value by value: a configuration that is merely accepted protects nothing."""

import json

from tailor.runtime.bus import zenoh_config

ENDPOINT = "tcp/127.0.0.1:7999"
ROUTER = json.loads(zenoh_config.router(ENDPOINT))
CLIENT = json.loads(zenoh_config.client(ENDPOINT))


def test_nothing_beyond_this_machine_is_reached_by_default():
    assert zenoh_config.DEFAULT_ENDPOINT == "tcp/127.0.0.1:7447"


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
        assert link["queue"]["size"] == dict.fromkeys(zenoh_config.PRIORITIES, 16)


def test_connections_that_send_nothing_are_many_and_soon_closed():
    assert ROUTER["transport"]["unicast"]["accept_pending"] == 2000
    assert ROUTER["transport"]["unicast"]["accept_timeout"] == 1000


def test_a_client_is_back_within_a_second_and_storms_nobody():
    retry = CLIENT["connect"]["retry"]
    assert retry == {"period_init_ms": 200, "period_max_ms": 200, "period_increase_factor": 1}


def test_requests_to_stop_and_to_arm_are_limited_in_rate_and_commands_are_not():
    (limits,) = ROUTER["downsampling"]
    rates = {rule["key_expr"]: rule["freq"] for rule in limits["rules"]}
    assert rates == dict.fromkeys(["*/arm_request", "*/self_arm", "estop"], 1000.0)
    assert (limits["flows"], sorted(limits["messages"])) == (["ingress"], ["delete", "put"])
