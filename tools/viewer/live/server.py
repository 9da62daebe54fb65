"""Serves the live page and its events (server-sent events) on the loopback interface.

The only input that it accepts is a press of the stop button.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

from tailor.schemas.errors import UsageError
from tailor.tools.viewer.live.broadcast import EventBroadcast, TooManyPagesError
from tailor.tools.viewer.live.stop_endpoint import PATH as STOP
from tailor.tools.viewer.live.stop_endpoint import StopEndpoint
from tailor.tools.viewer.live.subscription import Subscription

ADDRESS = "127.0.0.1"
OWN_NAMES = {"127.0.0.1", "localhost"}  # another Host header means DNS rebinding
MAX_PAGES = 5  # a browser opens six connections to one server; one must be left for the stop button
RETRY_MS = 1000  # until a page reconnects
BEAT_S = 2.0  # between comments that reveal a closed connection
NICENESS = 10  # of the events; the executive and the stop button have priority


@contextmanager
def serving(document: str, broadcast: EventBroadcast, port: int, stop: StopEndpoint | None = None) -> Iterator[int]:
    """Serve for the duration of the context; yields the port (a free one for port 0).

    Args:
      document: The page.
      broadcast: Its events.
      port: Port on the loopback interface.
      stop: The stop button; None: there is none, and every POST is refused.

    Raises:
      UsageError: The port is in use.
    """
    handler = type("Handler", (_Handler,), {"document": document.encode(), "broadcast": broadcast, "stop": stop})
    try:
        server = _Server((ADDRESS, port), handler)
    except OSError as error:
        raise UsageError(f"--port {port}: {error.strerror}, expected a free one (0 finds one)") from error
    server.daemon_threads = True
    thread = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.1}, daemon=True)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        broadcast.close()
        server.shutdown()
        server.server_close()


class _Server(ThreadingHTTPServer):
    """Its queue of connections holds what many tabs open at once: the stop button of one must not wait a second."""

    request_queue_size = 64


class _Handler(BaseHTTPRequestHandler):
    document: bytes
    broadcast: EventBroadcast
    stop: StopEndpoint | None
    timeout = 10  # seconds, of an idle socket

    def handle(self) -> None:
        with suppress(OSError):  # the other end is gone, or reads nothing: the base class prints a traceback
            super().handle()

    def do_GET(self) -> None:
        if self._closed_or_foreign():
            return
        if self.path == "/":
            self._send_body(self.document, "text/html; charset=utf-8")
        elif self.path != "/events":
            self.send_error(404)
        elif self.headers.get("Sec-Fetch-Site", "same-origin") not in ("same-origin", "none"):
            self.send_error(HTTPStatus.FORBIDDEN)  # pages of other sites would take the places of ours
        else:
            self._send_events()

    def do_POST(self) -> None:
        if self._closed_or_foreign():
            return
        port = self.connection.getsockname()[1]
        origins = {f"http://{name}:{port}" for name in OWN_NAMES}
        refusal = self.stop.refusal(self.headers, origins) if self.stop and self.path == STOP else HTTPStatus.FORBIDDEN
        if refusal is None and self.stop is not None:
            self._send_body(self.stop.pressed(), "application/json")
        else:
            self.send_error(refusal or HTTPStatus.FORBIDDEN)

    def _closed_or_foreign(self) -> bool:
        host = self.headers.get("Host", "").rpartition(":")[0] or self.headers.get("Host", "")
        if self.broadcast.closed:
            self.close_connection = True  # a preconnected socket; the browser would keep an error code
        elif host not in OWN_NAMES:
            self.send_error(HTTPStatus.FORBIDDEN)
        else:
            return False
        return True

    def log_message(self, *_: object) -> None:
        """Log no requests."""

    def _send_body(self, body: bytes, kind: str) -> None:
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Frame-Options", "DENY")  # no other page may lay the button under something to click at
        self.end_headers()
        self.wfile.write(body)

    def _send_events(self) -> None:
        self.close_connection = True
        if sys.platform == "linux":  # of this thread alone
            os.nice(NICENESS)
        try:
            with self.broadcast.subscribe(MAX_PAGES) as page:
                self._send_batches(page)
        except TooManyPagesError:
            self.send_error(503, "too many pages")

    def _send_batches(self, page: Subscription) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        try:
            token = {"stop": self.stop.token if self.stop else ""}  # a page outlives its server, and a token does not
            self._send(f"retry: {RETRY_MS}\nevent: reset\ndata: {json.dumps(token)}\n\n")
            while not page.lost:
                batch = page.next(BEAT_S)
                self._send(":\n\n" if batch is None else f"event: rows\ndata: {batch}\n\n")
        except OSError:
            return  # the page closed the connection

    def _send(self, text: str) -> None:
        self.wfile.write(text.encode())
        self.wfile.flush()
