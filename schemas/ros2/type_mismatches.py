"""Topics on which two nodes of rmw_zenoh do not hear each other, since their types differ. Pure.

Keys contain the type, so a base that takes Twist never receives a TwistStamped, and no error is reported: the robot
stands. Liveliness tokens name the topics of all nodes with their types.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tailor.schemas.ros2.graph import Announced, Kind, Named

_OTHER_END = {Kind.PUBLISHER: Kind.SUBSCRIPTION, Kind.SUBSCRIPTION: Kind.PUBLISHER}
_WORDS = {Kind.PUBLISHER: ("subscriber", "publish"), Kind.SUBSCRIPTION: ("publisher", "subscribe to")}


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A topic of ours that has no other end, except of another type.

    Attributes:
      kind: Our end, a publisher or a subscription.
      ours, theirs: The topic with our type, and with theirs.
    """

    kind: Kind
    ours: Named
    theirs: Named

    def __str__(self) -> str:
        end, we_do = _WORDS[self.kind]
        if self.theirs.type == self.ours.type:
            return f"{self.ours.name}: a {end} of another definition of {self.ours.type}, {self.theirs.hash[:15]}…"
        return f"{self.ours.name}: a {end} of {self.theirs.type}, we {we_do} {self.ours.type}"


def mismatches(ours: Iterable[tuple[Kind, Named]], announced: Iterable[Announced]) -> Iterator[Mismatch]:
    """Those of our publishers and subscriptions whose other ends all have another type.

    Args:
      ours: Kind and topic of each.
      announced: What all nodes announce, our own among them.
    """
    announced = list(announced)
    for kind, named in ours:
        wanted = _OTHER_END[kind]
        ends = {each.what for each in announced if each.kind is wanted and each.what and each.what.name == named.name}
        if ends and named not in ends:
            yield Mismatch(kind, named, min(ends, key=lambda end: (end.type, end.hash)))
