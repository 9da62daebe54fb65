"""What ROS 2 nodes under rmw_zenoh announce at the moment, by their liveliness tokens. Without zenoh."""

from __future__ import annotations

from threading import Lock

from tailor.schemas.ros2.graph import Announced, parsed_token


class GraphView:
    """The tokens that live; zenoh's thread notes them, any thread reads them."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._tokens: dict[str, Announced] = {}

    def note(self, token: str, lives: bool) -> None:
        """A token appeared or disappeared; other texts than tokens are left out."""
        announced = parsed_token(token)
        with self._lock:
            if lives and announced is not None:
                self._tokens[token] = announced
            else:
                self._tokens.pop(token, None)

    def announced(self) -> tuple[Announced, ...]:
        """What is announced now."""
        with self._lock:
            return tuple(self._tokens.values())
