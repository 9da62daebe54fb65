"""How rmw_zenoh names topics and services on the bus: data keys, and the liveliness tokens that show them to ROS 2.

The formats are those of rmw_zenoh since ROS 2 Jazzy. Pure text; loads neither zenoh nor rosbags.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

ADMIN_SPACE = "@ros2_lv"  # of the tokens; `**` does not match a part that begins with @
DEFAULT_DEPTH = 10  # of history
MAX_DIGITS = 3  # of a ROS_DOMAIN_ID; a stranger's key may have thousands, which Python refuses to convert


class Kind(Enum):
    """What a token announces."""

    NODE = "NN"
    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"


@dataclass(frozen=True, slots=True)
class Named:
    """One topic or service of ROS 2.

    Attributes:
      name: Without the first slash, e.g. "agilo/odom".
      type: ROS type, e.g. "nav_msgs/msg/Odometry".
      hash: Its RIHS01 hash; see `tailor.schemas.typesystem.hash_of`.
    """

    name: str
    type: str
    hash: str

    def key(self, domain: int | str) -> str:
        """The key of its data.

        Args:
          domain: ROS_DOMAIN_ID; "*" for a pattern that matches all.
        """
        return f"{domain}/{self.name}/{dds_name(self.type)}/{self.hash}"


@dataclass(frozen=True, slots=True)
class Node:
    """One ROS 2 node; each session of ours is one.

    Attributes:
      domain: ROS_DOMAIN_ID.
      session: zenoh's id of the session, in hexadecimal.
      name: Name of the node, without namespace.
    """

    domain: int
    session: str
    name: str

    def token(self) -> str:
        """Its own token."""
        return f"{self._start(0, Kind.NODE)}"

    def token_of(self, entity: int, kind: Kind, what: Named, qos: str) -> str:
        """Token of one of its publishers, subscriptions, services or clients.

        Args:
          entity: Number of the entity, unique in the session; the node itself is 0.
          kind: What the entity is.
          what: Its topic or service.
          qos: Its quality of service, from `qos`.
        """
        return f"{self._start(entity, kind)}/{mangled('/' + what.name)}/{dds_name(what.type)}/{what.hash}/{qos}"

    def _start(self, entity: int, kind: Kind) -> str:
        return f"{ADMIN_SPACE}/{self.domain}/{self.session}/0/{entity}/{kind.value}/%/%/{mangled(self.name)}"


@dataclass(frozen=True, slots=True)
class Announced:
    """What a token announces: a topic or service of a node, or the node itself (`what` is None)."""

    kind: Kind
    node: str
    what: Named | None


def dds_name(ros_type: str) -> str:
    """Type name inside keys: `dds_name("std_msgs/msg/Bool") == "std_msgs::msg::dds_::Bool_"`."""
    package, middle, name = ros_type.split("/")
    return f"{package}::{middle}::dds_::{name}_"


def ros_name(dds_type: str) -> str:
    """The ROS type of a type name inside a key; "" if it is none."""
    parts = dds_type.split("::")
    if len(parts) != 4 or parts[2] != "dds_" or not parts[3].endswith("_"):
        return ""
    return f"{parts[0]}/{parts[1]}/{parts[3][:-1]}"


def mangled(name: str) -> str:
    """A name as one part of a token."""
    return name.replace("/", "%")


def qos(depth: int = DEFAULT_DEPTH, reliable: bool = True, transient_local: bool = False) -> str:
    """Quality of service in a token: the last `depth` messages are kept; fields with ROS 2's defaults are empty."""
    return f"{'' if reliable else 2}:{1 if transient_local else ''}:,{depth}:,:,:,,"


def parsed_key(key: str) -> tuple[int, Named] | None:
    """Domain and topic of a data key; None for any other key."""
    domain, _, rest = key.partition("/")
    parts = rest.rsplit("/", 2)
    if not domain.isdecimal() or len(domain) > MAX_DIGITS or len(parts) != 3 or not parts[2].startswith("RIHS01_"):
        return None
    kind = ros_name(parts[1])
    return (int(domain), Named(parts[0], kind, parts[2])) if kind else None


def parsed_token(token: str) -> Announced | None:
    """What a token announces; None for any other text."""
    parts = token.split("/")
    kinds = {kind.value: kind for kind in Kind}
    if len(parts) < 9 or parts[0] != ADMIN_SPACE or parts[5] not in kinds:
        return None
    kind, node = kinds[parts[5]], parts[8].replace("%", "/")
    if kind is Kind.NODE:
        return Announced(kind, node, None) if len(parts) == 9 else None
    if len(parts) != 13:
        return None
    name, ros_type = parts[9].replace("%", "/").removeprefix("/"), ros_name(parts[10])
    return Announced(kind, node, Named(name, ros_type, parts[11])) if ros_type else None
