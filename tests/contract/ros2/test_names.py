"""Keys, type hashes and tokens under rmw_zenoh, pinned for every topic, and compared with what others compute.

After a deliberate change of a message, `python -m tests.contract.ros2.test_names` writes the pinned values again.
"""

import json
import sys
from pathlib import Path

import pytest

from tailor.schemas.ros2.action import achieve_goal, add_action
from tailor.schemas.ros2.graph import Kind, Node, qos
from tailor.schemas.ros2.profiles import ros_topic
from tailor.schemas.ros2.service import SET_GOAL, set_goal
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import hash_of, message_types, ros_type, type_hash
from tests.support.ros2.definitions import write_definitions

PINNED = Path(__file__).resolve().parents[2] / "data" / "ros2_names.json"
NODE = Node(0, "aac3178e146ba6f1fc6e6a4085e77f21", "tailor_driver")
SHARE = Path(sys.prefix) / "share"  # of the wheels ros-*-msgs
STANDARD = sorted({ros_type(kind) for kind in message_types() if kind.ROS_TYPE} | {"geometry_msgs/msg/Twist"})


def names():
    """Key, publisher's token and subscription's token of each topic; of the services those of server and client."""
    table = {name: (ros_topic(topic, "agilo"), Kind.PUBLISHER, Kind.SUBSCRIPTION) for name, topic in TOPICS.items()}
    parts = achieve_goal()
    for service in (set_goal(), *parts.services):
        table[service.name] = (service, Kind.SERVICE, Kind.CLIENT)
    for topic in parts.topics:
        table[topic.name] = (topic, Kind.PUBLISHER, Kind.SUBSCRIPTION)
    return {name: [row[0].key(0), *(token(row[0], kind) for kind in row[1:])] for name, row in table.items()}


def token(named, kind):
    return NODE.token_of(1, kind, named, qos(reliable=kind is not Kind.SUBSCRIPTION))


def test_keys_and_tokens_are_the_pinned_ones():
    assert names() == json.loads(PINNED.read_text()), "run: python -m tests.contract.ros2.test_names"


@pytest.fixture(scope="module")
def sdk(tmp_path_factory):
    """zenoh-ros2-sdk's own computation of a type hash, from `.msg` files."""
    utils = pytest.importorskip("zenoh_ros2_sdk.utils")
    folder = tmp_path_factory.mktemp("definitions")
    write_definitions(folder)

    registry = pytest.importorskip("zenoh_ros2_sdk.message_registry").MessageRegistry(str(folder))

    def computed(name):
        text = (folder / f"{name}.msg").read_text()
        parts = utils.load_dependencies_recursive(name, text, registry)
        return utils.get_type_hash(name, msg_definition=text, dependencies=parts)

    return computed


@pytest.mark.parametrize("name", TOPICS)
def test_zenoh_ros2_sdk_computes_the_same_keys_and_tokens(sdk, name):
    entity = pytest.importorskip("zenoh_ros2_sdk.entity")
    keyexpr = pytest.importorskip("zenoh_ros2_sdk.keyexpr")
    ours = ros_topic(TOPICS[name], "agilo")
    digest, dds = sdk(ours.type), ours.type.replace("/", "::").replace("msg::", "msg::dds_::") + "_"
    assert keyexpr.topic_keyexpr(0, f"/{ours.name}", dds, digest) == ours.key(0)
    node = entity.NodeEntity(0, NODE.session, 0, NODE.name, "/")
    for kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
        quality = qos()
        theirs = entity.EndpointEntity(
            node=node,
            entity_id=5,
            kind=entity.EntityKind(kind.value),
            name=f"/{ours.name}",
            dds_type_name=dds,
            type_hash=digest,
            qos=quality,
            gid=b"",
        )
        assert keyexpr.endpoint_liveliness_keyexpr(theirs) == NODE.token_of(5, kind, ours, quality)
    assert keyexpr.node_liveliness_keyexpr(node) == NODE.token()


def test_zenoh_ros2_sdk_computes_the_same_hash_of_the_service_and_the_same_quality_of_service():
    utils, quality = pytest.importorskip("zenoh_ros2_sdk.utils"), pytest.importorskip("zenoh_ros2_sdk.qos")
    from tailor.schemas.ros2.service import REQUEST, RESPONSE

    assert utils.compute_service_type_hash(SET_GOAL, REQUEST, RESPONSE) == set_goal().hash
    best_effort = quality.QosProfile(reliability=quality.QosReliability.BEST_EFFORT)
    assert [quality.QosProfile().encode(), best_effort.encode()] == [qos(), qos(reliable=False)]


def test_the_types_of_an_action_are_derived_as_ros_derives_them():
    """The hashes are those that `test_msgs` and `action_msgs` of ROS 2 Kilted state."""
    name = "test_msgs/action/Fibonacci"
    add_action(name, "int32 order", "int32[] sequence", "int32[] sequence")
    derived = ("Goal", "Result", "Feedback", "SendGoal", "GetResult", "FeedbackMessage")
    assert {part: hash_of(f"{name}_{part}").removeprefix("RIHS01_") for part in derived} == {
        "Goal": "e58ef5a8f4f039ab522a740823547c460b1d5aed8031c8b7825d33d345d90df8",
        "Result": "0774b095467813c6904d475498b5486b7ebd4cda6a4569f97e8de8c862689049",
        "Feedback": "7d1110f2efa019ad5ad8ad2244db98d862f39dc9fae8c976814b0065fa2f32d5",
        "SendGoal": "d807633803e38e164276573cd97e9fbd71e109c290bbf4cc312a0a1c9da7bbd9",
        "GetResult": "5d30fdeb21d20e117aa5f36c7b4f0b6874f1a8cf7a9c038d58f1156c5737b209",
        "FeedbackMessage": "37487bae8cea358366b97003c1ef1ca7ce7c08df36f9e8cca496624226aee64e",
    }
    parts = achieve_goal()
    assert parts.cancel_goal.hash == "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"
    assert parts.status.hash == "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"


@pytest.mark.parametrize("name", STANDARD)
def test_hashes_are_those_that_the_packages_of_ros_state(name):
    stated = SHARE / f"{name}.json"
    if not stated.exists():
        pytest.skip(f"{name}: its package is not installed (extra `ros`)")
    table = {row["type_name"]: row["hash_string"] for row in json.loads(stated.read_text())["type_hashes"]}
    assert table[name] == hash_of(name)
    kinds = {ros_type(kind): kind for kind in message_types()}
    assert name not in kinds or type_hash(kinds[name]) == table[name]


if __name__ == "__main__":
    PINNED.write_text(json.dumps(names(), indent=1) + "\n")
