"""What an observer knows of the executives on the bus: one, none, a restarted one, or several. Pure."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tailor.runtime.newest import Newest
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ExecStatus, Provenance, TickReport
from tailor.schemas.parsed_files import table_of
from tailor.schemas.topics import STALE_S, is_rate
from tailor.tools.status.picture import ExecutiveView
from tailor.tools.status.reading import topic_by_ending
from tailor.tools.status.ticks import TickTimer

MAX_EXECUTIVES = 8  # remembered; a flood of sender ids must not grow this process
MAX_REQUIRED = 20  # topics of one executive
FORGET_S = 60.0  # a silent executive that another one has replaced


@dataclass(slots=True)
class _Record:
    status: ExecStatus | None = None
    at_ns: int = 0
    introduced: bool = False  # its provenance has been received
    ticks: TickTimer = field(default_factory=TickTimer)
    realtime: dict[str, str] = field(default_factory=dict)
    required: dict[str, float] = field(default_factory=dict)


class Executives:
    """Executives by sender.

    Attributes:
      restarts: Executives whose first status came when another one had fallen silent.
    """

    def __init__(self) -> None:
        self.restarts = 0
        self._records: Newest[str, _Record] = Newest(MAX_EXECUTIVES)

    def status(self, sender: str, status: ExecStatus, now_ns: int) -> None:
        """Take a status."""
        record = self._record(sender)
        if record.status is None:
            others = [each for each in self._records.values() if each.status is not None]
            self.restarts += bool(others) and all(_silent(each, now_ns) for each in others)
        record.status, record.at_ns = status, now_ns

    def tick(self, sender: str, report: TickReport, now_ns: int) -> None:
        """Take a tick's report."""
        self._record(sender).ticks.add(now_ns, report)

    def provenance(self, sender: str, provenance: Provenance) -> None:
        """Take granted privileges and required topics; foreign content leaves them empty."""
        table, record = table_of(provenance.json), self._record(sender)
        table = {} if isinstance(table, Rejected) else table
        record.introduced = True
        record.realtime, record.required = _realtime(table), _required(table)

    def unknown(self, now_ns: int) -> bool:
        """Whether there is a live executive whose provenance has not been received yet."""
        live = (each for each in self._records.values() if each.status is not None and not _silent(each, now_ns))
        return not all(each.introduced for each in live)

    def views(self, now_ns: int) -> tuple[ExecutiveView, ...]:
        """All executives with a status, the most recent one first; long gone ones only if there is no other."""
        known = [(sender, each) for sender, each in self._records.items() if each.status is not None]
        known.sort(key=lambda row: -row[1].at_ns)
        kept = [row for row in known if _age_s(row[1], now_ns) <= FORGET_S] or known[:1]
        return tuple(_view(sender, record, now_ns) for sender, record in kept)

    def _record(self, sender: str) -> _Record:
        record = self._records.get(sender) or _Record()
        self._records.renew(sender, record)
        return record


def _age_s(record: _Record, now_ns: int) -> float:
    return max(0, now_ns - record.at_ns) / 1e9


def _silent(record: _Record, now_ns: int) -> bool:
    return _age_s(record, now_ns) > STALE_S


def _realtime(table: dict[str, Any]) -> dict[str, str]:
    granted = table.get("realtime")
    if not isinstance(granted, dict):
        return {}
    return {str(name): str(value)[:100] for name, value in list(granted.items())[:10]}


def _required(table: dict[str, Any]) -> dict[str, float]:
    stated = table.get("required")
    if not isinstance(stated, dict):
        return {}
    topics = ((key, value, topic_by_ending(key)) for key, value in list(stated.items())[:MAX_REQUIRED])
    return {key: float(value) if is_rate(value) else topic.rate_hz for key, value, topic in topics if topic is not None}


def _view(sender: str, record: _Record, now_ns: int) -> ExecutiveView:
    status = record.status
    assert status is not None, "only executives with a status are shown"
    return ExecutiveView(
        sender=sender,
        age_s=round(_age_s(record, now_ns), 3),
        silent=_silent(record, now_ns),
        mode=status.mode,
        reason=status.reason,
        detail=status.detail,
        scenario=status.scenario,
        goal=status.goal,
        result=status.result,
        result_reason=status.result_reason,
        result_detail=status.result_detail,
        action=status.action,
        action_elapsed_s=round(status.action_elapsed_s, 3),
        action_predicted_s=round(status.action_predicted_s, 3),
        ticks=record.ticks.times(now_ns),
        realtime=record.realtime,
        required=record.required,
    )
