"""Text of what a recorder has written and lost: for the supervisor, for people, as JSON."""

from __future__ import annotations

from typing import Any

from tailor.runtime.recordings.recorder import Health

DISCONNECTED = "bus disconnected: nothing is recorded until it reconnects"
RECONNECTED = "bus reconnected: recording continues"


def losses(health: Health, connected: bool) -> str:
    """What this recording lacks, for the supervisor; empty while it is whole."""
    if health.disk_error:
        return f"disk: {health.disk_error}"
    if not connected:
        return DISCONNECTED
    if health.drops or health.unwritten:
        return f"{health.drops.total() + health.unwritten} messages dropped"
    return "too many senders: some messages are recorded without theirs" if health.mixed else ""


def line(health: Health) -> str:
    """All of it in one line."""
    place = health.files[-1] if health.files else "in memory"
    text = f"{place}: {health.messages} messages, {health.bytes / 1e6:.1f} MB"
    if health.unwritten:
        text += f", {health.unwritten} not written"
    if health.drops:
        text += f", {health.drops.total()} dropped"
    if health.mixed:
        text += f", {health.mixed.total()} without their sender"
    return text + (f", disk: {health.disk_error}" if health.disk_error else "")


def json_value(health: Health) -> dict[str, Any]:
    """All of it, for --json."""
    return {
        "files": [str(path) for path in health.files],
        "messages": health.messages,
        "unwritten": health.unwritten,
        "bytes": health.bytes,
        "dropped": health.drops.total(),
        "without_sender": health.mixed.total(),
        "disk_error": health.disk_error or None,
    }
