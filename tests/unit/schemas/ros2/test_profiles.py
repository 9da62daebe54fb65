"""Which keys a session publishes under and hears, and whose plain key a key for rmw_zenoh is."""

import pytest

from tailor.schemas.messages import EStop
from tailor.schemas.ros2.graph import Named
from tailor.schemas.ros2.profiles import ESTOP_HASH, PROFILES, KeyProfile, ros_topic
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import type_hash

ROS = KeyProfile("rmw_zenoh", 3)


def test_the_hash_of_an_estop_that_is_not_computed_is_the_right_one():
    assert type_hash(EStop) == ESTOP_HASH


@pytest.mark.parametrize("name", TOPICS)
def test_the_key_of_every_topic_is_read_back_as_its_plain_key(name):
    topic = TOPICS[name]
    assert ROS.heard(ros_topic(topic, "agilo").key(3)) == (topic.key.format(robot="agilo"), topic)


@pytest.mark.parametrize("name", TOPICS)
def test_every_topic_has_a_key_in_every_profile_and_both_have_two(name):
    topic = TOPICS[name]
    used = {profile: (KeyProfile(profile).plain(topic), KeyProfile(profile).ros(topic)) for profile in PROFILES}
    stops = topic.type is EStop
    assert used == {"plain": (True, stops), "rmw_zenoh": (stops, True), "both": (True, True)}


def test_a_key_with_another_type_hash_domain_or_topic_stays_as_it_is():
    odom = ros_topic(TOPICS["odom"], "agilo")
    other = "RIHS01_" + 64 * "0"
    keys = [
        Named(odom.name, odom.type, other).key(3),
        Named(odom.name, "nav_msgs/msg/Path", odom.hash).key(3),
        Named("agilo/scan", odom.type, odom.hash).key(3),
        odom.key(4),
        "agilo/odom",
    ]
    assert [ROS.heard(key) for key in keys] == [None] * 5


def test_the_plain_profile_hears_nothing_but_estops_under_keys_of_ros():
    plain = KeyProfile()
    assert plain.heard(ros_topic(TOPICS["odom"], "agilo").key(0)) is None
    assert plain.heard(ros_topic(TOPICS["estop"], "").key(0)) == ("estop", TOPICS["estop"])
