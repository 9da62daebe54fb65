"""The only place of a soak that opens sessions: people's, and an intruder's."""

from __future__ import annotations

from contextlib import AbstractContextManager

from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.rights.run_folder import VARIABLE
from tailor.runtime.bus.session import Session


def open_people(endpoint: str, timeout_s: float = 3.0) -> AbstractContextManager[Session]:
    """Session that may arm, stop and set goals. Raises UsageError if it cannot be opened."""
    return open_client(endpoint, timeout_s, role="people")


def open_intruder(endpoint: str, sender: str) -> AbstractContextManager[Session]:
    """Session of a process that wants more than it may: an observer's, or one without credentials.

    Raises:
      UsageError: It is refused.
    """
    return open_client(endpoint, sender=sender, role="observer")


def stranger_environment(empty: str) -> dict[str, str]:
    """Environment of a process that finds no credentials, as of another user; `empty` is an empty folder."""
    return {VARIABLE: empty}
