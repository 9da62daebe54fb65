"""What a session leaves behind when it closes: nothing, as a driver whose base is off opens thousands of them a day."""

from types import SimpleNamespace

import pytest
import zenoh

from tailor.runtime.bus import session
from tailor.runtime.bus.zenoh_config import client


class Opened:
    """zenoh's session, with what becomes of it and of its publishers."""

    info = SimpleNamespace(zid=lambda: "1")

    def __init__(self, events):
        self._events = events

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._events.append("closed")

    def liveliness(self):
        return SimpleNamespace(declare_token=lambda key: key)

    def declare_publisher(self, key, **_):
        def undeclare():
            self._events.append(key)
            if key == "lost":
                raise zenoh.ZError("of a session that was lost")

        return SimpleNamespace(undeclare=undeclare)


@pytest.mark.parametrize("ends", [None, ConnectionError("the base")])
def test_publishers_end_before_their_session(monkeypatch, ends):
    """One that outlived it kept 14 kB: of a base that was off for a day, 100 MB."""
    events = []
    monkeypatch.setattr(session.zenoh, "open", lambda config: Opened(events))
    try:
        with session.opened(client(["tcp/127.0.0.1:7447"])) as ours:
            kept = [ours.plain_publisher("lost", "application/cdr"), ours.publisher("odom", "agilo")]
            kept.append(ours.player("other/key", ""))
            if ends is not None:
                raise ends
    except ConnectionError:
        pass
    assert len(kept) == 3
    assert events == ["lost", "agilo/odom", "other/key", "closed"]
