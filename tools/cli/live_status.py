"""Status of a running system: a live panel in a terminal, a line per change in a pipe or log."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Protocol

from rich.console import Console
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from tailor.runtime.aside import Aside, aside
from tailor.schemas.messages import ActionFinished, ExecStatus, Message, PlanReport, ProcessStates, Subgoals, TickReport
from tailor.schemas.reason_text import reason_text, result_text, without_numbers
from tailor.tools.cli.plain_text import plain


class Screen(Protocol):
    """Output for lines and for messages of the executive."""

    def report(self, line: str) -> None:
        """Print one permanent line."""
        ...

    def show(self, message: Message) -> None:
        """Show a message of the executive, or the states of the processes."""
        ...


class _Lines:
    """For logs and pipes: a line per change."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._last = ""

    def report(self, line: str) -> None:
        self._console.print(line, highlight=False, markup=False, soft_wrap=True)  # a line stays one for its reader

    def show(self, message: Message) -> None:
        line = plain(_summary(message))
        event = without_numbers(line) if isinstance(message, ExecStatus) else line  # a measured value changes each tick
        if line and event != self._last:
            self._last = event
            self.report(line)


class _Panel:
    """For terminals: a live table below the permanent lines."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._status: ExecStatus | None = None
        self._tick: TickReport | None = None
        self._processes: ProcessStates | None = None

    def report(self, line: str) -> None:
        self._live.console.print(Text(line, style=colour_of(line)))

    def show(self, message: Message) -> None:
        if isinstance(message, ExecStatus):
            self._status = message
        elif isinstance(message, TickReport):
            self._tick = message
        elif isinstance(message, ProcessStates):
            self._processes = message
        elif isinstance(message, ActionFinished | PlanReport) and (line := plain(_summary(message))):
            self.report(line)
        self._live.update(self._table())

    def _table(self) -> Table:
        grid = Table.grid(padding=(0, 2))
        status, tick = self._status, self._tick
        if self._processes is not None:
            grid.add_row("processes", _text(processes_text(self._processes)))
        if status is None:
            grid.add_row("waiting for the executive")
            return grid
        mode = _text(f"{status.mode} {reason_text(status.reason, status.detail)}".strip(), colour_of(status.mode))
        grid.add_row("mode", mode)
        predicted = max(status.action_predicted_s, 0.1)
        if status.action:
            bar = ProgressBar(total=predicted, completed=min(status.action_elapsed_s, predicted), width=30)
            elapsed = f"{status.action_elapsed_s:.1f} of {predicted:.1f} s predicted"
            grid.add_row("action", _text(f"{status.action}  {elapsed}"))
            grid.add_row("", bar)
        grid.add_row("belief", "  ".join(f"{value:6.2f}" for value in status.belief[:6]))
        if tick is not None:
            work, late = tick.work_ns / 1e6, tick.lateness_ns / 1e6
            grid.add_row("tick", f"{tick.tick}  work {work:.1f} ms  late {late:.2f} ms  checks {tick.checks_granted}")
        return grid


def _text(line: str, style: str = "") -> Text:
    """What comes from the bus: neither markup nor control characters."""
    return Text(plain(line), style=style)


COLOURS = {
    "red": ("FAULT", "failed", "killed", "ended with", "estopped", "did not start"),
    "yellow": ("HOLDING", "DISARMED", "stopped", "aborted", "warning"),
    "green": ("achieved", "done"),
    "cyan": ("EXECUTING",),
}


def colour_of(line: str) -> str:
    """Colour of a line for people by the state that it names; empty: none."""
    return next((colour for colour, words in COLOURS.items() if any(word in line for word in words)), "")


def processes_text(states: ProcessStates) -> str:
    """Processes with their states, e.g. "sim running  executive running (2 starts)  record ended"."""
    parts = []
    for process in states.processes:
        starts = f" ({process.starts} starts)" if process.starts > 1 else ""
        parts.append(f"{process.name} {process.state}{starts}" + (f": {process.status}" if process.status else ""))
    return "  ".join(parts)


class _Beside:
    """Another screen, for which nobody waits: a terminal may stand still (Ctrl-S), or the disk of a log be full."""

    def __init__(self, shown: Screen, terminal: Aside) -> None:
        self._shown, self._terminal = shown, terminal

    def report(self, line: str) -> None:
        self._terminal.output(partial(self._shown.report, line))

    def show(self, message: Message) -> None:
        self._terminal.output(partial(self._shown.show, message))


@contextmanager
def screen(quiet: bool = False) -> Iterator[Screen]:
    """Screen for the kind of stdout: `_Panel` for a terminal, `_Lines` otherwise; quiet: lines on stderr."""
    console = Console(stderr=quiet)
    if quiet or not console.is_terminal:
        with aside() as terminal:
            yield _Beside(_Lines(console), terminal)
        return
    with Live(console=console, refresh_per_second=10, transient=True) as live, aside() as terminal:
        yield _Beside(_Panel(live), terminal)


def _summary(message: Message) -> str:
    if isinstance(message, ActionFinished):
        duration = f"{message.actual_s:.1f} s, predicted {message.predicted_s:.1f} s"
        reason = f" ({reason_text(message.reason, message.detail)})" if message.reason else ""
        surprise = f", {message.detail}" if message.detail and not message.reason else ""
        return f"  {message.action} {message.outcome}{reason}: {duration}{surprise}"
    if isinstance(message, PlanReport) and message.status == "failed":
        return f"  {reason_text(message.reason, message.detail)}"
    if isinstance(message, ExecStatus):
        if message.result or message.action:
            result = result_text(message.result, message.result_reason, message.result_detail)
            return f"  {result or message.action}"
        return f"  {message.mode} {reason_text(message.reason, message.detail)}" if message.reason else ""
    if isinstance(message, Subgoals) and message.actions:
        chosen = [f"{p.name} {p.value:z.2f}" for p in message.actions[0].parameters if not p.bound]
        return f"  {message.actions[0].action} with {', '.join(chosen)}" if chosen else ""
    return ""
