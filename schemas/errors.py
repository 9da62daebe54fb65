"""What goes wrong outside: a user's mistake to be told in one line, and a message to be refused."""

from __future__ import annotations

from dataclasses import dataclass


class UsageError(Exception):
    """A user's input cannot be used. The message says in one line what, where and what was expected.

    `tailor` prints it without a traceback and exits with code 2; nothing has been started by then.
    """


@dataclass(frozen=True, slots=True)
class Rejected:
    """A message from the bus that was refused; a value, never an exception."""

    reason: str
