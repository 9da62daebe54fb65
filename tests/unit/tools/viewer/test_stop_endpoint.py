"""The live page's stop button over plain HTTP: it works, also beside a flood, and nobody else's page can press it."""

import http.client
import json
import re
import socket
import threading
import time

import pytest

from tailor.schemas.messages import DriverState
from tailor.tools.viewer.live import server
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.live.server import serving
from tailor.tools.viewer.live.stop_endpoint import StopEndpoint
from tailor.tools.viewer.page import page
from tailor.tools.viewer.timeline import Event
from tests.support.patience import PATIENCE_S
from tests.support.stalls import repeat_on_stall

BESIDE_A_FLOOD_S = 0.3
PAUSE_S = 0.001  # for every 50 events: a flood of 30 000/s that leaves the stall meter CPU time to measure


def state(mode):
    return DriverState(0, mode, "", "", 1, "", 0)


class Button:
    def __init__(self, **modes):
        self.states = {robot: state(mode) for robot, mode in modes.items()}
        self.presses = 0

    def press(self):
        self.presses += 1
        return self.states


@pytest.fixture
def button():
    return Button(agilo="estopped")


@pytest.fixture
def live(button):
    """(port, token) of a live page."""
    endpoint = StopEndpoint(button.press)
    document = page("live", [], live=True, stop_token=endpoint.token)
    with serving(document, EventBroadcast(), 0, endpoint) as port:
        yield port, endpoint.token


def post(port, token="", path="/stop", method="POST", body=None, **headers):
    """(status, body) of a request as the page sends it, with changes."""
    sent = {"Host": f"127.0.0.1:{port}", "Origin": f"http://127.0.0.1:{port}", "X-Stop-Token": token}
    sent |= {name.replace("_", "-"): value for name, value in headers.items()}
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request(method, path, body, {name: value for name, value in sent.items() if value is not None})
    response = connection.getresponse()
    content = response.read()
    connection.close()
    return response.status, content


def test_a_press_stops_the_drivers_and_answers_what_they_confirm(live, button):
    status, content = post(*live)
    assert (status, json.loads(content)) == (
        200,
        {"confirmed": True, "drivers": {"agilo": "estopped"}, "connected": True},
    )
    assert button.presses == 1


@pytest.mark.parametrize("modes", [{}, {"agilo": "armed"}, {"agilo": "estopped", "nomad": "stopped"}])
def test_what_was_not_confirmed_is_no_success(modes):
    endpoint = StopEndpoint(Button(**modes).press)
    assert json.loads(endpoint.pressed()) == {"confirmed": False, "drivers": modes, "connected": True}


def test_a_press_without_a_bus_answers_that_it_reached_nothing():
    endpoint = StopEndpoint(Button().press, connected=lambda: False)
    assert json.loads(endpoint.pressed()) == {"confirmed": False, "drivers": {}, "connected": False}


def test_the_page_that_is_served_holds_the_token_and_a_recorded_one_no_button(live):
    port, token = live
    status, content = post(port, path="/", method="GET")
    assert status == 200
    data = json.loads(re.search(r'id="data">(.*?)</script>', content.decode()).group(1))
    assert (data["stop"], data["live"]) == (token, True)
    assert len(token) >= 43, "256 bits"
    assert '"stop":""' in page("recorded", [])


@pytest.mark.promise("P45")
@pytest.mark.parametrize(
    "changes",
    [
        {"token": ""},
        {"token": "x" * 43},
        {"token": "ä"},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": None},
        {"Origin": "http://127.0.0.1:1"},
        {"Host": "evil.example"},
        {"Host": "evil.example:80"},
        {"path": "/stop/"},
        {"path": "/stop?"},
        {"path": "/"},
        {"path": "/events"},
    ],
)
def test_another_sites_page_cannot_press_it(live, button, changes):
    port, token = live
    assert post(port, **{"token": token, **changes})[0] == 403
    assert button.presses == 0


def test_a_page_that_reconnects_to_another_server_learns_its_token(live):
    port, token = live
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", "/events")
    response = connection.getresponse()
    lines = [response.readline() for _ in range(3)]
    response.close()
    assert lines[2] == f'data: {{"stop": "{token}"}}\n'.encode()
    connection.close()


@pytest.mark.parametrize("method", ["GET", "PUT", "DELETE", "HEAD", "OPTIONS"])
def test_only_a_post_presses_it(live, button, method):
    assert post(*live, method=method)[0] in (404, 501)
    assert button.presses == 0


def test_a_press_has_no_body(live, button):
    assert post(*live, body=b"x")[0] == 413
    assert post(*live, Transfer_Encoding="chunked")[0] == 413
    assert post(*live, Content_Length="-1")[0] == 413
    assert button.presses == 0


def test_without_a_button_every_post_is_refused():
    with serving("page", EventBroadcast(), 0) as port:
        assert post(port)[0] == 403


def test_the_page_listens_on_the_loopback_interface_alone(live):
    port, _ = live
    with open("/proc/net/tcp") as sockets:
        addresses = [line.split()[1] for line in sockets if line.split()[3] == "0A"]  # listening
    assert [address for address in addresses if address.endswith(f":{port:04X}")] == [f"0100007F:{port:04X}"]


def test_no_other_page_may_frame_it(live):
    port, _ = live
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    connection.request("GET", "/")
    assert connection.getresponse().getheader("X-Frame-Options") == "DENY"


def test_a_browser_keeps_a_connection_for_the_button():
    assert server.MAX_PAGES < 6, "browsers open six to one server, for all their tabs together"


@pytest.mark.promise("P45")
def test_the_button_works_while_events_flood_the_pages(button):
    endpoint, broadcast, ended = StopEndpoint(button.press), EventBroadcast(), threading.Event()

    def flood():
        while not ended.is_set():
            broadcast.publish([Event(time.monotonic(), "tick", {"work": 1.0})] * 50)
            time.sleep(PAUSE_S)

    def pressed():
        began_s = time.monotonic()
        assert post(port, endpoint.token)[0] == 200
        assert time.monotonic() - began_s <= BESIDE_A_FLOOD_S

    with serving("page", broadcast, 0, endpoint) as port:
        pages = [socket.create_connection(("127.0.0.1", port)) for _ in range(server.MAX_PAGES)]
        for each in pages:  # they ask for the events and never read them
            each.sendall(f"GET /events HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        thread = threading.Thread(target=flood)
        thread.start()
        try:
            for _ in range(5):
                repeat_on_stall(5, pressed)
        finally:
            ended.set()
            thread.join()
            for each in pages:
                each.close()
    assert button.presses >= 5
