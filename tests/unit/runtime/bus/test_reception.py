"""When a message was received, by the wall clock of its receiver."""

from types import SimpleNamespace

import pytest
import zenoh

from tailor.runtime.bus.wires import received_raw

SECOND = 1_000_000_000


def sample(stamped_s):
    """A publication that zenoh has stamped on its reception; None: has not."""
    reception = SimpleNamespace(
        point=zenoh.InterceptionPoint.RECEIVE, is_custom=False, timestamp=lambda: f"{stamped_s << 32}/id"
    )
    stack = None if stamped_s is None else SimpleNamespace(records=[reception])
    parts = {"key_expr": "agilo/odom", "payload": SimpleNamespace(to_bytes=bytes), "attachment": None, "encoding": ""}
    return SimpleNamespace(**parts, timestamp_stack=stack, kind=zenoh.SampleKind.PUT)


@pytest.mark.parametrize(
    ("stamped_s", "at_s", "received_s"),
    [(100, 101, 100), (100, 100, 100), (None, 101, 101), (3700, 101, 101)],
    ids=["earlier than it is read", "at once", "unstamped", "the wall clock was set back by an hour"],
)
def test_a_message_is_received_when_zenoh_says_but_not_in_the_future(stamped_s, at_s, received_s):
    assert received_raw(sample(stamped_s), at_s * SECOND).received_wall_ns == received_s * SECOND
