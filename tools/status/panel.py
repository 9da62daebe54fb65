"""Draws a picture of the system for a terminal: verdict and problems first, so that a small window shows them."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from tailor.schemas.reason_text import reason_text, result_text
from tailor.tools.cli.plain_text import plain
from tailor.tools.status.picture import (
    DriverView,
    ExecutiveView,
    Finding,
    ForeignView,
    LauncherView,
    Picture,
    Spread,
    TickTimes,
    TopicView,
)
from tailor.tools.status.ticks import WINDOW_NS

GOOD, BAD, WEAK = "green", "bold red", "dim"
MODES = {
    "EXECUTING": "bold green",
    "READY": GOOD,
    "DISARMED": "yellow",
    "HOLDING": "bold yellow",
    "FAULT": BAD,
    "armed": "bold green",
    "disarmed": "yellow",
    "stopped": BAD,
    "estopped": BAD,
}
MAX_FOREIGN = 6  # keys that are named


def panel(picture: Picture, endpoint: str) -> RenderableType:
    """The whole picture."""
    parts: list[RenderableType] = [_verdict(picture, endpoint)]
    parts += [_problem(finding) for finding in picture.problems]
    parts += [_executive(executive, picture.observed_s) for executive in picture.executives]
    if picture.drivers:
        parts.append(_drivers(picture.drivers))
    parts.append(_launcher(picture.launcher))
    if picture.topics:
        parts.append(_topics(picture.topics))
    parts += _foreign(picture.foreign)
    return Group(*parts)


def _verdict(picture: Picture, endpoint: str) -> Text:
    count = len(picture.problems)
    verdict = ("healthy", GOOD) if picture.healthy else (f"{count} problem{'s'[: count != 1]}", BAD)
    return Text.assemble(verdict).append(f"   {endpoint}, observed for {_rounded(picture.observed_s)} s", WEAK)


def _problem(finding: Finding) -> Text:
    return Text("  ").append(finding.problem, BAD).append(plain(f": {finding.detail}"))


def _mode(mode: str) -> Text:
    return Text(plain(mode), MODES.get(mode, BAD))


def _executive(executive: ExecutiveView, observed_s: float) -> RenderableType:
    grid = Table.grid(padding=(0, 2))
    name = Text(f"executive {executive.sender[:8]}", "bold")
    if executive.silent:
        grid.add_row(name, Text(f"silent for {executive.age_s:.1f} s", BAD))
        return Padding(grid, (1, 0, 0, 0))
    state = _mode(executive.mode).append(plain(f" {reason_text(executive.reason, executive.detail)}"), "default")
    grid.add_row(name, state)
    grid.add_row("task", Text(plain(_task(executive))))
    if executive.action:
        elapsed = f"{executive.action_elapsed_s:.1f} of {executive.action_predicted_s:.1f} s predicted"
        grid.add_row("action", Text(plain(f"{executive.action}  {elapsed}")))
    if executive.ticks is not None:
        grid.add_row("ticks p50/p99/max", _ticks(executive.ticks, observed_s))
    if executive.realtime:
        granted = ", ".join(f"{name} {value}" for name, value in executive.realtime.items())
        grid.add_row("granted", Text(plain(granted), WEAK))
    return Padding(grid, (1, 0, 0, 0))


def _task(executive: ExecutiveView) -> str:
    result = result_text(executive.result, executive.result_reason, executive.result_detail)
    return "  ".join(filter(None, (executive.scenario, executive.goal, result)))


def _ticks(ticks: TickTimes, observed_s: float) -> Text:
    span = "minute" if observed_s >= WINDOW_NS / 1e9 else f"{_rounded(observed_s)} s"
    text = Text(f"{ticks.reported} in the last {span}, ")
    text.append(f"{ticks.skipped} skipped", BAD if ticks.skipped else "default")
    return text.append(f"; work {_spread(ticks.work_ms)}, late {_spread(ticks.lateness_ms)} ms")


def _rounded(seconds: float) -> str:
    return f"{round(seconds, 1 if seconds < 10.0 else 0):g}"


def _spread(spread: Spread) -> str:
    return f"{spread.p50:.1f}/{spread.p99:.1f}/{spread.max:.1f}"


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold", pad_edge=False)
    for column in columns:
        table.add_column(column.rstrip(">"), justify="right" if column.endswith(">") else "left")
    return table


def _drivers(drivers: Sequence[DriverView]) -> RenderableType:
    table = _table("driver", "mode", "reason", "obeys", "epoch", "accepted>", "refused", "age s>")
    for driver in drivers:
        refused = ", ".join(f"{count} {reason}" for reason, count in driver.refused.items())
        obeys = f"{driver.armed_sender[:8]} ({driver.armed_for})" if driver.armed_sender else "nobody"
        table.add_row(
            plain(driver.robot),
            _mode("silent" if driver.silent else driver.mode),
            Text(plain(reason_text(driver.reason, driver.detail))),
            Text(obeys, BAD if driver.armed_for == "absent" else "default"),
            f"{driver.epoch & 0xFFFFFFFF:08x}" + (f" (restart {driver.restarts})" if driver.restarts else ""),
            str(driver.accepted),
            Text(plain(refused or "none")),
            Text(f"{driver.age_s:.2f}", BAD if driver.silent else "default"),
        )
    return Padding(table, (1, 0, 0, 0))


def _launcher(launcher: LauncherView | None) -> RenderableType:
    if launcher is None:
        return Padding(Text("not launched by tailor up", WEAK), (1, 0, 0, 0))
    table = _table("process", "state", "pid>", "starts>", "silent s>", "lacks")
    for process in launcher.processes:
        table.add_row(
            Text(plain(process.name)),
            Text(plain(process.state), GOOD if process.state == "running" else BAD),
            str(process.pid),
            str(process.starts),
            f"{process.silent_s:.1f}",
            Text(plain(process.status), BAD),
        )
    return Padding(table, (1, 0, 0, 0))


def _topics(topics: Sequence[TopicView]) -> RenderableType:
    table = _table("topic", "Hz>", "of>", "age s>", "limit>", "received>", "senders>")
    for topic in topics:
        periodic = topic.nominal_hz > 0
        table.add_row(
            Text(plain(topic.key)),
            Text(_rate(topic), BAD if topic.slow else "default" if periodic else WEAK),
            f"{topic.nominal_hz:g}" if periodic else "",
            Text(f"{topic.age_s:.2f}", BAD if topic.stale else "default"),
            "" if topic.stale_after_s is None else f"{topic.stale_after_s:g}",
            str(topic.received),
            Text(str(topic.senders), BAD if periodic and topic.senders > 1 else "default"),
        )
    return Padding(table, (1, 0, 0, 0))


def _rate(topic: TopicView) -> str:
    if topic.nominal_hz <= 0:
        return topic.published
    return "" if topic.rate_hz is None else f"{topic.rate_hz:.1f}"


def _foreign(foreign: ForeignView) -> list[RenderableType]:
    if not foreign.unknown:
        return []
    named = [f"{key} {count}" for key, count in list(foreign.unknown.items())[:MAX_FOREIGN]]
    more = len(foreign.unknown) - len(named)
    text = ", ".join(named) + (f" and {more} more keys" if more > 0 else "")
    return [Padding(Text(plain(f"not ours: {text}"), "yellow"), (1, 0, 0, 0))]
