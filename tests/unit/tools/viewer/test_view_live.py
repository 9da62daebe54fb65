"""The live page's server: new pages receive all events, slow ones are disconnected, only this machine is served."""

from __future__ import annotations

import http.client
import json
import socket
import struct
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.schemas import messages as m
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.tools.viewer.live import broadcast as broadcast_module
from tailor.tools.viewer.live import server
from tailor.tools.viewer.live.broadcast import MAX_RECENT, EventBroadcast
from tailor.tools.viewer.live.bus_listener import BusListener
from tailor.tools.viewer.live.server import serving
from tailor.tools.viewer.live.subscription import MAX_WAITING
from tailor.tools.viewer.timeline import Event, RunTimeline
from tests.support.patience import PATIENCE_S, wait_until


def test_many_tabs_connect_at_once_however_busy_the_server_is():
    with server._Server(("127.0.0.1", 0), server._Handler) as busy:  # it accepts nothing
        sockets = [socket.socket() for _ in range(40)]
        for each in sockets:
            each.settimeout(PATIENCE_S)
        try:
            for each in sockets[:6]:
                each.connect(busy.server_address)
            for each in sockets[6:]:
                each.settimeout(0.5)
                each.connect(busy.server_address)
        finally:
            for each in sockets:
                each.close()


def tick(at_s: float) -> Event:
    return Event(at_s, "tick", {"work": 1.0})


def raw(message: m.Message, key: str = "exec/status", sender: str = "ab" * 16, wall_ns: int = 10**18) -> Raw:
    attachment = pack(Origin(1, 0, sender))
    return Raw(key, encode(message), attachment, encoding_of(type(message)), True, wall_ns)


def status(mode: str = "READY") -> m.ExecStatus:
    return m.ExecStatus(0, 1, mode, "", "", "", "", "", 0, 0.0, 0.0)


@contextmanager
def events(port: int):
    """The lines of the event stream."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", "/events")
    answer = connection.getresponse()
    assert answer.getheader("Content-Type") == "text/event-stream"
    yield iter(answer.readline, b"")
    answer.close()
    connection.close()


def next_events(lines) -> list:
    for line in lines:
        if line.startswith(b"data: ["):
            return json.loads(line[6:])
    raise AssertionError("the stream has ended")


def answer(port: int, path: str, host: str = "127.0.0.1", **headers: str) -> http.client.HTTPResponse:
    """An answer; its connection is open for as long as somebody holds it."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", path, headers={"Host": host, **headers})
    return connection.getresponse()


def get(port: int, path: str, host: str = "127.0.0.1", **headers: str) -> int:
    return answer(port, path, host, **headers).status


def test_a_new_page_receives_past_and_future_events() -> None:
    broadcast = EventBroadcast()
    broadcast.publish([tick(0.0)])
    with broadcast.subscribe() as page:
        broadcast.publish([tick(0.1)])
        assert json.loads(page.next(0)) == [[0.0, "tick", {"work": 1.0}]]
        assert json.loads(page.next(0)) == [[0.1, "tick", {"work": 1.0}]]
        assert page.next(0) is None
    assert broadcast.pages == 0


def test_events_are_encoded_once_for_all_pages(monkeypatch) -> None:
    """Those of ten minutes take a quarter of a second, during which the stop button of another page would wait."""
    broadcast = EventBroadcast()
    broadcast.publish([tick(0.0)])
    monkeypatch.setattr(broadcast_module, "compact_json", lambda value: pytest.fail("once more"))
    with broadcast.subscribe() as page:
        assert json.loads(page.next(0)) == [[0.0, "tick", {"work": 1.0}]]


def test_old_ticks_are_dropped_and_old_events_are_not() -> None:
    broadcast = EventBroadcast(keep_s=10)
    broadcast.publish([Event(0.0, "plan", {}), tick(0.0)])
    for k in range(200):
        broadcast.publish([tick(k)])
    with broadcast.subscribe() as page:
        kept = json.loads(page.next(0))
    assert kept[0][1] == "plan"
    assert 10 <= len(kept) <= 80
    assert kept[-1][0] == 199


def test_a_live_page_of_weeks_does_not_grow_and_a_new_one_shows_what_holds(monkeypatch) -> None:
    monkeypatch.setattr(broadcast_module, "KEEP_EVENTS", 5)
    broadcast = EventBroadcast(keep_s=10)
    broadcast.publish([Event(0.0, "plan", {}), Event(0.0, "state", {}), Event(0.0, "driver", {})])
    for k in range(1, 1000):
        broadcast.publish([Event(float(k), "subgoals", {"k": k}), Event(float(k), "finished", {"k": k})])
    with broadcast.subscribe() as page:
        kept = json.loads(page.next(0))
    assert [kind for _, kind, _ in kept[:3]] == ["plan", "state", "driver"], "in force since the start"
    assert len(kept) <= 3 + 2 * 80
    assert kept == sorted(kept, key=lambda row: row[0])
    for k in range(1000, 1061):
        broadcast.publish([tick(float(k))])
    with broadcast.subscribe() as page:
        kept = json.loads(page.next(0))
    assert [fields["k"] for _, kind, fields in kept if kind == "subgoals"] == [995, 996, 997, 998, 999]


def test_of_a_flood_the_newest_are_kept() -> None:
    broadcast = EventBroadcast()
    broadcast.publish([Event(50.0, "subgoals", {"k": k}) for k in range(MAX_RECENT + 10)])
    broadcast.publish([tick(60.0)])
    with broadcast.subscribe() as page:
        kept = [fields["k"] for _, kind, fields in json.loads(page.next(0)) if kind == "subgoals"]
    assert kept == list(range(10, MAX_RECENT + 10))


def test_the_run_after_an_hour_drops_old_ticks_too() -> None:
    broadcast = EventBroadcast(keep_s=10)
    broadcast.publish([tick(3600.0)])
    broadcast.restart()
    broadcast.publish([tick(k) for k in range(200)])
    with broadcast.subscribe() as page:
        assert len(json.loads(page.next(0))) <= 80


def test_old_alternatives_are_dropped_but_the_newest() -> None:
    broadcast = EventBroadcast(keep_s=10)
    for k in range(3):
        broadcast.publish([Event(float(k), "subgoals", {}), Event(float(k), "why", {"k": k})])
    broadcast.publish([tick(100.0)])
    with broadcast.subscribe() as page:
        kept = [(kind, fields) for _, kind, fields in json.loads(page.next(0)) if kind in ("subgoals", "why")]
    assert kept == [("subgoals", {})] * 3 + [("why", {"k": 2})]


def test_a_page_that_does_not_read_is_disconnected_and_blocks_no_other() -> None:
    broadcast = EventBroadcast()
    with broadcast.subscribe() as page:
        for k in range(2 * MAX_WAITING):
            broadcast.publish([tick(k)])
        assert page.lost


def test_the_server_serves_the_page_and_its_events_and_nothing_else() -> None:
    broadcast = EventBroadcast()
    with serving("<p>page</p>", broadcast, 0) as port:
        assert get(port, "/") == 200
        assert get(port, "/etc/passwd") == 404
        broadcast.publish([tick(0.0)])
        with events(port) as lines:
            assert (next(lines), next(lines)) == (b"retry: 1000\n", b"event: reset\n")
            assert next_events(lines) == [[0.0, "tick", {"work": 1.0}]]
            broadcast.publish([tick(0.5)])
            assert next_events(lines) == [[0.5, "tick", {"work": 1.0}]]


def test_a_host_name_that_resolves_here_is_refused() -> None:
    with serving("page", EventBroadcast(), 0) as port:
        assert get(port, "/", host="evil.example:80") == 403
        assert get(port, "/events", host="evil.example") == 403
        assert get(port, "/", host=f"localhost:{port}") == 200


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_a_page_of_another_site_takes_no_place_of_ours_but_may_link_to_us(site: str) -> None:
    with serving("page", EventBroadcast(), 0) as port:
        assert get(port, "/events", **{"Sec-Fetch-Site": site}) == 403
        assert get(port, "/", **{"Sec-Fetch-Site": site}) == 200


def test_a_connection_that_is_reset_prints_nothing(capfd) -> None:
    others = set(threading.enumerate())  # of tests before
    with serving("page", EventBroadcast(), 0) as port:
        for request in (b"", b"GE", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"):
            connection = socket.create_connection(("127.0.0.1", port))
            connection.sendall(request)
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            connection.close()  # with a reset
        assert get(port, "/") == 200
        ours = set(threading.enumerate()) - others
        wait_until(lambda: not [thread for thread in ours if "process_request" in thread.name and thread.is_alive()])
    assert capfd.readouterr().err == ""


def test_the_server_listens_on_this_machine_alone() -> None:
    with serving("page", EventBroadcast(), 0) as port, socket.socket() as other:
        other.bind(("127.0.0.2", port))  # free: the server does not listen at every address


def test_too_many_pages_are_refused(monkeypatch) -> None:
    monkeypatch.setattr(server, "MAX_PAGES", 1)
    with serving("page", EventBroadcast(), 0) as port, events(port) as lines:
        next(lines)
        next_events(lines)
        assert get(port, "/events") == 503


@pytest.mark.skipif(sys.platform != "linux", reason="only there is the priority of a thread lowered")
def test_of_pages_that_connect_at_once_no_more_are_taken_than_may_be(monkeypatch) -> None:
    """A browser that opens all its pages again leaves a connection for the stop button."""
    monkeypatch.setattr(server, "MAX_PAGES", 1)
    both = threading.Barrier(2)
    monkeypatch.setattr(server.os, "nice", lambda _: both.wait(PATIENCE_S))
    with serving("page", EventBroadcast(), 0) as port, ThreadPoolExecutor(2) as pages:
        answers = list(pages.map(lambda _: answer(port, "/events"), range(2)))
        assert sorted(each.status for each in answers) == [200, 503]


def test_a_port_in_use_is_an_error_of_one_line() -> None:
    with (
        serving("page", EventBroadcast(), 0) as port,
        pytest.raises(UsageError, match=f"--port {port}"),
        serving("", EventBroadcast(), port),
    ):
        pass


def test_what_arrives_on_the_bus_reaches_the_page_with_its_time() -> None:
    intake, broadcast, wall = IngestQueue(), EventBroadcast(), iter((10**18, 10**18 + 10**9))
    listener = BusListener(intake, RunTimeline(), broadcast, "", 0, wall.__next__)
    intake.put(raw(status()))
    intake.put(raw(m.Odometry(0, 1.5, 0.0, 0.0, 0.2, 0.0), "agilo/odom", wall_ns=10**18 + 250_000_000))
    listener.poll(10**9)
    with broadcast.subscribe() as page:
        *events, (_, last, silent) = json.loads(page.next(0))
    assert (last, silent) == ("silent", {"executive": 0.0}), "its status is a second old"
    assert [kind for _, kind, _ in events] == ["state", "action", "belief", "odom"]
    assert events[-1][0] == 0.25
    assert events[-1][2]["x"] == 1.5


def test_a_wall_clock_that_is_set_back_stops_no_page() -> None:
    intake, broadcast, hour_ns = IngestQueue(), EventBroadcast(), 3600 * 10**9
    walls = [10**18 + k * 10**9 - hour_ns * (k > 5) for k in range(11)]
    listener = BusListener(intake, RunTimeline(), broadcast, "", 0, iter(walls).__next__)
    for k, wall_ns in list(enumerate(walls))[1:]:
        intake.put(raw(m.Odometry(0, float(k), 0.0, 0.0, 0.2, 0.0), "agilo/odom", wall_ns=wall_ns - 1000))
        listener.poll(k * 10**9)
    with broadcast.subscribe() as page:
        events = json.loads(page.next(0))
    assert [fields["x"] for _, kind, fields in events if kind == "odom"] == [float(k) for k in range(1, 11)]
    assert [at_s for at_s, kind, _ in events if kind == "odom"] == pytest.approx(
        [float(k) for k in range(10)], abs=0.01
    )


def test_a_held_switch_is_one_event_and_every_stop_is_one() -> None:
    timeline = RunTimeline()
    messages = [False] * 50 + [True, True] + [False] * 50
    found = [event for k, stop in enumerate(messages) for event in timeline.events_of(0.1 * k, "estop", m.EStop(stop))]
    assert [event.fields["stop"] for event in found] == [False, True, True, False]


def test_old_samples_are_forgotten_once_a_minute_only() -> None:
    broadcast = EventBroadcast(keep_s=60.0)
    broadcast.publish([Event(0.0, "state", {})])
    kept = []
    for k in range(3000):
        broadcast.publish([Event(0.1 * k, "odom", {"x": float(k)})])
        kept.append(broadcast._events)
    assert len({id(events) for events in kept}) <= 6
    assert len(kept[-1]) <= 1202


def test_damaged_foreign_and_unwanted_messages_are_left_out() -> None:
    intake, broadcast = IngestQueue(), EventBroadcast()
    good = raw(status())
    intake.put(Raw(good.key, good.payload[:-9], good.attachment, good.encoding, True, 1))
    intake.put(Raw("exec/status", b"hello", None, "text/plain", True, 1))
    intake.put(Raw(good.key, good.payload, good.attachment, good.encoding, False, 1))
    intake.put(raw(status(), sender="cd" * 16))
    BusListener(intake, RunTimeline(), broadcast, "ab", 0).poll(1)
    with broadcast.subscribe() as page:
        assert json.loads(page.next(0)) == []


def test_a_listener_sends_signs_of_life_and_the_silence_of_what_it_heard_although_nothing_arrives() -> None:
    intake, broadcast = IngestQueue(), EventBroadcast()
    intake.put(raw(status()))
    listener = BusListener(intake, RunTimeline(), broadcast, "", 0, connected=lambda: False)
    with broadcast.subscribe() as page:
        for now_ns in (4 * 10**8, 4 * 10**8 + 1, 3 * 10**9):
            listener.poll(now_ns)
        batches = [json.loads(page.next(0)) for _ in range(5)]
    assert [[kind for _, kind, _ in batch] for batch in batches] == [
        [],
        ["state", "action", "belief"],
        ["now"],
        ["silent"],
        ["now"],
    ]
    assert batches[2][0][2] == {"bus": False}
    assert batches[3][0] == [3.0, "silent", {"executive": 0.0}]
    with broadcast.subscribe() as later:
        assert "now" not in later.next(0), "a sign of life is not kept"


def test_another_run_begins_with_an_empty_page() -> None:
    broadcast = EventBroadcast()
    broadcast.publish([tick(0.0)])
    with broadcast.subscribe() as page:
        broadcast.restart()
        assert page.lost
    assert not broadcast.closed
    with broadcast.subscribe() as page:
        assert page.next(0) == "[]"
