"""Who may publish, call and serve what: the rules themselves, key by key. tests/faults tries them on a live bus."""

import pytest
import zenoh

from tailor.runtime.bus.rights import access
from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.graph import Kind, Node, qos
from tailor.schemas.ros2.profiles import ros_topic
from tailor.schemas.ros2.service import set_goal
from tailor.schemas.services import ROLES
from tailor.schemas.topics import TOPICS

SUBJECTS = [{"id": role, "usernames": [role]} for role in (*ROLES, access.GATEWAY)]
TABLE = access.access_control(SUBJECTS)
RULES = {rule["id"]: rule for rule in TABLE["rules"]}
COMMANDS = {"*/cmd_vel", "*/joint_cmd"}
ACTION_TOPICS = {named.key("*") for named in achieve_goal().topics}
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


def test_only_a_driver_publishes_sensors_besides_a_player():
    for key in ("*/odom", "*/pose", "*/ball", "*/joint_states", "*/sim/truth"):
        assert {role for role in ROLES if key in allowed(role, "put")} == {"driver", "player"}


def test_only_a_driver_publishes_its_state_by_which_it_confirms_an_estop():
    assert [role for role in ROLES if "*/driver" in allowed(role, "put")] == ["driver"]


@pytest.mark.parametrize("role", ["observer", "recorder"])
def test_who_only_looks_publishes_nothing(role):
    assert allowed(role, "put") == set()


def test_a_player_of_recordings_drives_arms_and_stops_nobody():
    assert allowed("player", "put") & (COMMANDS | {"*/self_arm", "*/arm_request", "estop"}) == set()


def test_nobody_publishes_on_a_pattern_that_matches_several_topics():
    keys = set().union(*(allowed(role, "put") for role in ROLES))
    plain = {topic.key.format(robot="*") for topic in TOPICS.values()}
    assert keys <= plain | {ros_topic(topic, "*").key("*") for topic in TOPICS.values()} | ACTION_TOPICS


def test_only_the_executive_publishes_what_becomes_of_the_goals_of_the_action():
    for key in ACTION_TOPICS:
        assert [role for role in ROLES if key in allowed(role, "put")] == ["executive"]
    for named in achieve_goal().topics:
        token = Node(0, "ab", "node").token_of(1, Kind.PUBLISHER, named, qos())
        announcers = {role: [zenoh.KeyExpr(key) for key in allowed(role, "liveliness_token")] for role in ROLES}
        assert [role for role in ROLES if any(key.includes(token) for key in announcers[role])] == ["executive"]


@pytest.mark.parametrize("name", TOPICS)
def test_the_key_for_ros_gives_no_role_more_than_the_plain_key(name):
    plain, ros = TOPICS[name].key.format(robot="*"), ros_topic(TOPICS[name], "*").key("*")
    allowed_to = {key: [role for role in ROLES if key in allowed(role, "put")] for key in (plain, ros)}
    assert allowed_to[ros] == allowed_to[plain]


@pytest.mark.parametrize("name", TOPICS)
def test_only_who_may_publish_a_topic_is_announced_as_its_publisher(name):
    topic = TOPICS[name]
    token = Node(0, "ab", "node").token_of(1, Kind.PUBLISHER, ros_topic(topic, "agilo"), qos())
    roles = [role for role in ROLES if any(zenoh.KeyExpr(k).includes(token) for k in allowed(role, "liveliness_token"))]
    assert roles == [role for role in ROLES if role in access.may_publish(topic)]


def test_everybody_may_announce_a_node_and_a_subscription_and_look_at_the_graph():
    node = Node(0, "ab", "node")
    for role in ROLES:
        patterns = [zenoh.KeyExpr(key) for key in allowed(role, "liveliness_token")]
        for token in (node.token(), node.token_of(1, Kind.SUBSCRIPTION, ros_topic(TOPICS["cmd_vel"], "a"), qos())):
            assert any(pattern.includes(token) for pattern in patterns)
        assert allowed(role, "liveliness_query") == allowed(role, "declare_liveliness_subscriber") == {"@ros2_lv/**"}


@pytest.mark.parametrize("service", [set_goal(), *achieve_goal().services], ids=lambda named: named.name)
def test_only_the_executive_is_announced_as_the_server_of_goals_and_only_people_as_its_clients(service):
    for kind, only in ((Kind.SERVICE, "executive"), (Kind.CLIENT, "people")):
        token = Node(0, "ab", "node").token_of(1, kind, service, qos())
        patterns = {role: [zenoh.KeyExpr(key) for key in allowed(role, "liveliness_token")] for role in ROLES}
        assert [role for role in ROLES if any(pattern.includes(token) for pattern in patterns[role])] == [only]


@pytest.mark.parametrize(
    ("service", "server"),
    [
        ("exec/goal", "executive"),
        (set_goal().key("*"), "executive"),
        *((named.key("*"), "executive") for named in achieve_goal().services),
        ("*/sim/*", "driver"),
        ("recorder/snapshot", "recorder"),
    ],
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
    assert allowed(access.GATEWAY, "put") == {"**", "@ros2_lv/**"}
    assert [role for role in ROLES if access.GATEWAY in {rule["id"] for rule in rules_of(role)}] == []


def test_every_topic_and_request_has_a_largest_size():
    limits = access.size_limits()
    sizes = {key: limit["size_limit"] for limit in limits for key in limit["key_exprs"] if limit["messages"] == ["put"]}
    plain = {topic.key.format(robot="*"): topic.max_bytes for topic in TOPICS.values()}
    ros = {ros_topic(topic, "*").key("*"): topic.max_bytes for topic in TOPICS.values()}
    assert sizes == plain | ros | dict.fromkeys(ACTION_TOPICS, 65536)
    assert (sizes["*/cmd_vel"], sizes["estop"]) == (4096, 4096)
    assert {"flows": ["ingress"], "messages": ["query"], "key_exprs": ["**"], "size_limit": 65536} in limits
    assert {tuple(limit["flows"]) for limit in limits} == {("ingress",)}


def test_e_stops_are_limited_in_rate_and_nothing_else():
    (limits,) = access.rate_limits()
    rates = {rule["key_expr"]: rule["freq"] for rule in limits["rules"]}
    assert rates == dict.fromkeys(["estop", ros_topic(TOPICS["estop"], "*").key("*")], 1000.0)
    assert (limits["flows"], sorted(limits["messages"])) == (["ingress"], ["delete", "put"])
