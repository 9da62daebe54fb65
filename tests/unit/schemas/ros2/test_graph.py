"""Keys and tokens as rmw_zenoh writes them; the examples are those of its design document."""

from hypothesis import given
from hypothesis import strategies as st

from tailor.schemas.ros2.graph import Announced, Kind, Named, Node, dds_name, parsed_key, parsed_token, qos, ros_name

STRING = Named(
    "chatter", "std_msgs/msg/String", "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
)
TALKER = Node(2, "aac3178e146ba6f1fc6e6a4085e77f21", "talker")
TOKEN = (
    "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MP/%/%/talker/%chatter/std_msgs::msg::dds_::String_/"
    "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18/::,7:,:,:,,"
)
NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,8}(/[a-z][a-z0-9_]{0,8}){0,2}", fullmatch=True)


def test_keys_and_tokens_are_those_of_the_design_document():
    assert STRING.key(2) == f"2/chatter/std_msgs::msg::dds_::String_/{STRING.hash}"
    assert TALKER.token() == "@ros2_lv/2/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/talker"
    assert TALKER.token_of(10, Kind.PUBLISHER, STRING, qos(7)) == TOKEN


def test_only_what_differs_from_the_defaults_is_in_a_quality_of_service():
    assert qos(5, reliable=False) == "2::,5:,:,:,,"
    assert qos(1000, transient_local=True) == ":1:,1000:,:,:,,"


@given(NAMES, st.integers(0, 232))
def test_a_key_is_read_back(name, domain):
    topic = Named(name, "nav_msgs/msg/Odometry", STRING.hash)
    assert parsed_key(topic.key(domain)) == (domain, topic)


@given(NAMES, st.sampled_from([kind for kind in Kind if kind is not Kind.NODE]))
def test_a_token_is_read_back(name, kind):
    topic = Named(name, "nav_msgs/msg/Odometry", STRING.hash)
    assert parsed_token(TALKER.token_of(3, kind, topic, qos())) == Announced(kind, "talker", topic)
    assert parsed_token(TALKER.token()) == Announced(Kind.NODE, "talker", None)


@given(st.text(st.sampled_from("0/a:%@_sNR")))
def test_any_other_text_is_neither(text):
    assert parsed_key(text) is None
    assert parsed_token(text) is None
    assert parsed_token(f"@ros2_lv/{text}") is None


def test_a_domain_of_more_digits_than_python_converts_is_none():
    assert parsed_key(STRING.key("9" * 5000)) is None


def test_a_plain_key_of_ours_is_no_key_of_ros():
    assert parsed_key("agilo/odom") is None
    assert parsed_key("0/agilo/odom") is None


def test_type_names_are_read_back():
    assert ros_name(dds_name("tailor_msgs/srv/SetGoal")) == "tailor_msgs/srv/SetGoal"
    assert (ros_name("Bool"), ros_name("a::b::c::d_")) == ("", "")
