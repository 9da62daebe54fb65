"""Serves the live page and its events (server-sent events) on the loopback interface. It accepts no input."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread

from tailor.schemas.errors import UsageError
from tailor.tools.viewer.broadcast import EventBroadcast

ADDRESS = "127.0.0.1"
OWN_NAMES = {"127.0.0.1", "localhost"}  # another Host header means DNS rebinding
MAX_PAGES = 8
RETRY_MS = 1000  # until a page reconnects
BEAT_S = 2.0  # between comments that reveal a closed connection


@contextmanager
def serving(document: str, broadcast: EventBroadcast, port: int) -> Iterator[int]:
    """Serve for the duration of the context; yields the port (a free one for port 0).

    Raises:
      UsageError: The port is in use.
    """
    handler = type("Handler", (_Handler,), {"document": document.encode(), "broadcast": broadcast})
    try:
        server = ThreadingHTTPServer((ADDRESS, port), handler)
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


class _Handler(BaseHTTPRequestHandler):
    document: bytes
    broadcast: EventBroadcast
    timeout = 10  # seconds, of an idle socket

    def do_GET(self) -> None:
        host = self.headers.get("Host", "").rpartition(":")[0] or self.headers.get("Host", "")
        if self.broadcast.closed:
            self.close_connection = True  # a preconnected socket; the browser would keep an error code
        elif host not in OWN_NAMES:
            self.send_error(403)
        elif self.path == "/":
            self._send_document()
        elif self.path != "/events":
            self.send_error(404)
        elif self.broadcast.pages >= MAX_PAGES:
            self.send_error(503, "too many pages")
        else:
            self._send_events()

    def log_message(self, *_: object) -> None:
        """Log no requests."""

    def _send_document(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self.document)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(self.document)

    def _send_events(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.close_connection = True
        try:
            self._send(f"retry: {RETRY_MS}\nevent: reset\ndata: all\n\n")
            with self.broadcast.subscribe() as page:
                while not page.lost:
                    batch = page.next(BEAT_S)
                    self._send(":\n\n" if batch is None else f"event: rows\ndata: {batch}\n\n")
        except OSError:
            return  # the page closed the connection

    def _send(self, text: str) -> None:
        self.wfile.write(text.encode())
        self.wfile.flush()
