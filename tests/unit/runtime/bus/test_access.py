"""Who may publish, call and serve what: the rules themselves, key by key. tests/faults tries them on a live bus."""

import pytest

from tailor.runtime.bus import access
from tailor.schemas.services import ROLES
from tailor.schemas.topics import TOPICS

SUBJECTS = [{"id": role, "usernames": [role]} for role in (*ROLES, access.GATEWAY)]
TABLE = access.access_control(SUBJECTS)
RULES = {rule["id"]: rule for rule in TABLE["rules"]}
COMMANDS = {"*/cmd_vel", "*/joint_cmd"}
PEOPLES = {"*/arm_request", "estop", "clock"}


def rules_of(role):
    (policy,) = [policy for policy in TABLE["policies"] if policy["subjects"] == [role]]
    return [RULES[name] for name in policy["rules"]]


def allowed(role, message):
    """Keys on which a role may send a message into the router."""
    rules = [rule for rule in rules_of(role) if message in rule["messages"] and "ingress" in rule["flows"]]
    return {key for rule in rules for key in rule["key_exprs"]}


def test_what_no_rule_allows_is_denied():
    assert (TABLE["enabled"], TABLE["default_permission"]) == (True, "deny")
    assert {rule["permission"] for rule in TABLE["rules"]} == {"allow"}
    assert [policy["subjects"] for policy in TABLE["policies"]] == [[subject["id"]] for subject in SUBJECTS]


def test_only_the_executive_commands_and_requests_to_arm_itself():
    for key in (*COMMANDS, "*/self_arm", "exec/plan_request", "exec/provenance"):
        others = {role for role in ROLES if key in allowed(role, "put")} - {"executive"}
        assert "executive" in {role for role in ROLES if key in allowed(role, "put")}
        assert others == (set() if key in COMMANDS | {"*/self_arm"} else {"player"})


def test_only_people_arm_and_stop():
    for key in ("*/arm_request", "estop"):
        assert [role for role in ROLES if key in allowed(role, "put")] == ["people"]


def test_only_a_driver_publishes_sensors_and_its_state_besides_a_player():
    for key in ("*/odom", "*/pose", "*/ball", "*/joint_states", "*/driver", "*/sim/truth"):
        assert {role for role in ROLES if key in allowed(role, "put")} == {"driver", "player"}


@pytest.mark.parametrize("role", ["observer", "recorder"])
def test_who_only_looks_publishes_nothing(role):
    assert allowed(role, "put") == set()


def test_a_player_of_recordings_drives_arms_and_stops_nobody():
    assert allowed("player", "put") & (COMMANDS | {"*/self_arm", "*/arm_request", "estop"}) == set()


def test_nobody_publishes_on_a_pattern_that_matches_several_topics():
    keys = set().union(*(allowed(role, "put") for role in ROLES))
    assert keys <= {topic.key.format(robot="*") for topic in TOPICS.values()}


@pytest.mark.parametrize(
    ("service", "server"), [("exec/goal", "executive"), ("*/sim/*", "driver"), ("recorder/snapshot", "recorder")]
)
def test_a_service_has_one_server_and_is_called_by_people(service, server):
    for message in ("declare_queryable", "reply"):
        assert [role for role in ROLES if service in allowed(role, message)] == [server]
    assert [role for role in ROLES if service in allowed(role, "query")] == ["people"]


def test_everybody_may_subscribe_to_everything_and_query_nothing_else():
    for role in ROLES:
        assert allowed(role, "declare_subscriber") == {"**"}
        assert allowed(role, "delete") == set()
        assert "**" not in allowed(role, "query") | allowed(role, "put")


def test_only_the_gateway_passes_everything_on():
    assert allowed(access.GATEWAY, "put") == {"**"}
    assert [role for role in ROLES if access.GATEWAY in {rule["id"] for rule in rules_of(role)}] == []


def test_every_topic_and_request_has_a_largest_size():
    limits = access.size_limits()
    sizes = {key: limit["size_limit"] for limit in limits for key in limit["key_exprs"] if limit["messages"] == ["put"]}
    assert sizes == {topic.key.format(robot="*"): topic.max_bytes for topic in TOPICS.values()}
    assert (sizes["*/cmd_vel"], sizes["estop"]) == (4096, 4096)
    assert {"flows": ["ingress"], "messages": ["query"], "key_exprs": ["**"], "size_limit": 65536} in limits
    assert {tuple(limit["flows"]) for limit in limits} == {("ingress",)}


def test_requests_to_stop_and_to_arm_are_limited_in_rate_and_commands_are_not():
    (limits,) = access.rate_limits()
    rates = {rule["key_expr"]: rule["freq"] for rule in limits["rules"]}
    assert rates == dict.fromkeys(["*/arm_request", "*/self_arm", "estop"], 1000.0)
    assert (limits["flows"], sorted(limits["messages"])) == (["ingress"], ["delete", "put"])
