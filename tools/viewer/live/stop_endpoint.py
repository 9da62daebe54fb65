"""The stop button's half of the server: who may press it, and what a press answers.

The page is served on the loopback interface, but a page of any other site in the same browser could send a request
there. It is refused: it knows no token, since it cannot read ours, and its browser names another origin.
"""

from __future__ import annotations

import hmac
import json
import secrets
from collections.abc import Callable, Mapping
from email.message import Message
from http import HTTPStatus

from tailor.schemas.messages import DriverState
from tailor.tools.operator.stop_button import all_stopped

PATH = "/stop"
TOKEN_HEADER = "X-Stop-Token"


class StopEndpoint:
    """Emergency stop by a POST of the page.

    Attributes:
      token: Random; the page sends it in the header TOKEN_HEADER.
    """

    def __init__(
        self, press: Callable[[], Mapping[str, DriverState]], connected: Callable[[], bool] = lambda: True
    ) -> None:
        """`press`: stops every driver and returns their states, by robot; `connected`: whether it reaches the bus.

        Both are called from any thread.
        """
        self.token = secrets.token_urlsafe(32)
        self._press, self._connected = press, connected

    def refusal(self, headers: Message, origins: set[str]) -> HTTPStatus | None:
        """Why a POST is refused; None if it is not.

        Args:
          headers: Of the request.
          origins: Our own, e.g. http://127.0.0.1:7450.
        """
        if headers.get("Content-Length", "0") != "0" or "Transfer-Encoding" in headers:
            return HTTPStatus.REQUEST_ENTITY_TOO_LARGE  # a press has no body, so none is read
        token = headers.get(TOKEN_HEADER, "").encode("utf-8", "surrogateescape")
        if headers.get("Origin", "") not in origins or not hmac.compare_digest(token, self.token.encode()):
            return HTTPStatus.FORBIDDEN
        return None

    def pressed(self) -> bytes:
        """Stop every driver; a JSON object: whether all have confirmed, the mode of each, and whether the bus heard."""
        states = self._press()
        modes = {robot: state.mode for robot, state in sorted(states.items())}
        answer = {"confirmed": all_stopped(states), "drivers": modes, "connected": self._connected()}
        return json.dumps(answer).encode()
