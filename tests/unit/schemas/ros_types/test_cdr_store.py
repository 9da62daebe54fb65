"""The store knows of ROS 2's types what rosbags knows, and loads late those that no process of a robot needs."""

import subprocess
import sys
from dataclasses import make_dataclass

import pytest
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

from tailor.schemas import typesystem
from tailor.schemas.messages import Message
from tailor.schemas.packages.msg_definitions import declarations
from tailor.schemas.ros_types.cdr_store import CdrStore
from tailor.schemas.ros_types.common_interfaces import COMMON
from tailor.schemas.ros_types.plain_definitions import read_definition
from tests.support.bus_system import ROOT

EVENT = "service_msgs/msg/ServiceEventInfo"  # Jazzy writes the type of its ids otherwise


@pytest.mark.parametrize("name", sorted(COMMON.keys() - {EVENT}))
def test_a_common_type_is_the_one_of_jazzy(name):
    assert read_definition(COMMON[name]) == get_typestore(Stores.ROS2_JAZZY).fielddefs[name]


def test_the_event_of_a_service_is_the_one_of_jazzy_but_for_its_ids():
    text = COMMON[EVENT].replace("uint8[16]", "char[16]")
    assert read_definition(text)[1] == get_typestore(Stores.ROS2_JAZZY).fielddefs[EVENT][1]


@pytest.mark.parametrize("kind", typesystem.own_types())
def test_a_definition_of_ours_is_read_as_rosbags_reads_it(kind):
    text, name = "\n".join(declarations(kind).values()), typesystem.ros_type(kind)
    assert {name: read_definition(text)} == get_types_from_msg(text, name)


@pytest.mark.parametrize("name", ["sensor_msgs/msg/BatteryState", "std_msgs/msg/Empty"])
def test_any_type_of_jazzy_is_known(name):
    whole = get_typestore(Stores.ROS2_JAZZY)
    assert CdrStore({}, 10).hash_rihs01(name) == whole.hash_rihs01(name)
    assert CdrStore({}, 10).get_msgdef(name).cls is whole.types[name]


def test_an_unknown_type_is_a_key_error():
    with pytest.raises(KeyError):
        CdrStore({}, 10).get_msgdef("sensor_msgs/msg/Nothing")
    with pytest.raises(KeyError):
        CdrStore({}, 10).hash_rihs01("sensor_msgs/msg/Nothing")


def test_a_part_of_a_new_type_may_be_any_of_jazzy():
    store = CdrStore({}, 10)
    store.register(get_types_from_msg("sensor_msgs/NavSatFix[] fixes", "some_msgs/msg/Fixes"))
    assert "NavSatStatus" in store.generate_msgdef("some_msgs/msg/Fixes", ros_version=2)[0]
    assert len(store.serialize_cdr(store.types["some_msgs/msg/Fixes"]([]), "some_msgs/msg/Fixes")) == 8


def angle(name):
    """A message of a package, of one field."""
    return make_dataclass(name, [("angle", float)], bases=(Message,), namespace={"ROS_PACKAGE": "geometry_msgs"})


@pytest.mark.parametrize("name", ["Pose", "Polygon"])  # of them each process knows the first
def test_a_package_cannot_define_a_type_of_ros_2_otherwise(monkeypatch, name):
    own = typesystem.own_types()
    monkeypatch.setattr(typesystem, "own_types", lambda: (*own, angle(name)))
    with pytest.raises(TypesysError, match=f"geometry_msgs/msg/{name}"):
        typesystem.typestore.__wrapped__()


def test_no_process_of_a_robot_defines_all_types_of_ros_2():
    code = (
        "import sys; from tailor.schemas import codec; from tailor.schemas.ros2 import action_messages, service;"
        "codec.prime(); action_messages.prime(); service.prime(); print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    loaded = done.stdout.split()
    assert "rosbags.typesys.store" in loaded
    assert not [name for name in loaded if name.startswith("rosbags.typesys.stores.ros")]
