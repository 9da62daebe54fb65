"""Lines for people from the messages of a run: modes, plans, actions with their durations, results."""

from __future__ import annotations

from collections.abc import Iterator

from tailor.schemas import messages as m
from tailor.schemas.reason_text import reason_text, result_text, without_numbers

TROUBLE = ("FAULT", "HOLDING", "stopped", "estopped")


class RunLog:
    """Log of one run; a line only where something changes, and not for numbers alone."""

    def __init__(self) -> None:
        self._last: dict[str, str] = {}  # by what it is about

    def lines_of(self, key: str, message: m.Message) -> Iterator[m.LogLine]:
        """Lines that follow from one message."""
        if isinstance(message, m.ExecStatus):
            mode = f"{message.mode} {reason_text(message.reason, message.detail)}".strip()
            yield from self._changed("mode", message.stamp_ns, mode, _level(message.mode))
            action = f"{message.action} begins, predicted {message.action_predicted_s:.2f} s" if message.action else ""
            index = str(message.action_index) if message.action else ""
            if self._last.get("index", "") != index:
                self._last["index"] = index
                if action:
                    yield m.LogLine(message.stamp_ns, m.INFO, "action", action)
            result = result_text(message.result, message.result_reason, message.result_detail)
            level = m.ERROR if result.startswith("failed") else m.INFO
            yield from self._changed("result", message.stamp_ns, result, level)
        elif isinstance(message, m.ActionFinished):
            why = reason_text(message.reason, message.detail)
            text = f"{message.action} {message.outcome} after {message.actual_s:.2f} s{f': {why}' if why else ''}"
            yield m.LogLine(message.stamp_ns, m.INFO if message.outcome == "done" else m.WARNING, "action", text)
        elif isinstance(message, m.PlanReport):
            text = f"plan {message.status} ({message.way}), {message.generated} plans generated"
            yield m.LogLine(message.stamp_ns, m.INFO if message.status == "solved" else m.WARNING, "plan", text)
        elif isinstance(message, m.DriverState):
            mode = f"{message.mode} {reason_text(message.reason, message.detail)}".strip()
            yield from self._changed(key, message.stamp_ns, mode, _level(message.mode))

    def _changed(self, name: str, stamp_ns: int, text: str, level: int) -> Iterator[m.LogLine]:
        event = without_numbers(text)
        if self._last.get(name, "") != event:
            self._last[name] = event
            if text:
                yield m.LogLine(stamp_ns, level, name, text)


def _level(mode: str) -> int:
    return m.WARNING if mode in TROUBLE else m.INFO
