"""The flag --sender: a launcher gives each of its children an id on the bus, by which it knows their messages."""

from __future__ import annotations

import argparse
import re

from tailor.schemas.errors import UsageError


def configure_sender(parser: argparse.ArgumentParser) -> None:
    """Add the flag."""
    parser.add_argument("--sender", metavar="HEX", default="", help="sender id, 32 hex digits (default: random)")


def sender_of(arguments: argparse.Namespace) -> str:
    """Sender id, or "" for a random one; raises UsageError for anything else."""
    return checked_sender(arguments.sender, "--sender")


def checked_sender(sender: str | None, flag: str) -> str:
    """Value of a flag that holds a sender id, "" without one; raises UsageError for anything else."""
    if sender and not re.fullmatch("[0-9a-f]{32}", sender):
        raise UsageError(f"{flag} {sender}: expected 32 hex digits")
    return sender or ""
