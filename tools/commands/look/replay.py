"""Play a recording on the bus at its recorded times, with the recorded bytes, sequence numbers and senders.

Keys: space pauses and resumes, right (or s) sends the next message while paused, up and down change the rate, q quits.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from functools import partial
from typing import Any

import numpy as np

from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.recordings.playback_clock import MAX_RATE, MIN_RATE, PlaybackClock
from tailor.runtime.recordings.player import PlaybackStats, Player
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.selection import Selection, selection
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Clock
from tailor.schemas.topics import TOPICS
from tailor.tools.cli.keyboard import Keyboard
from tailor.tools.cli.number_checks import check_within
from tailor.tools.cli.selection_flags import configure_selection
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus, open_bus
from tailor.tools.recordings.playback import Publishers, RecordingPart, remapping
from tailor.tools.recordings.substitution import OMITTED, SUBSTITUTES, armed_for, live_executive

OF_ROBOTS = tuple(name for name, topic in TOPICS.items() if not topic.playable)
SECURED = "the bus is secured: a replay may neither drive there nor pass for a driver (`tailor bus --security open`)"
LISTEN_S = 0.5  # for a live driver; drivers publish at 10 Hz
MAX_S = 1e9  # beyond any recording
MAX_CLOCK_HZ = 10_000.0
LAST_CLOCK_NS = (2**31 - 1) * 10**9  # ROS's clock ends in 2038
TAIL_S = 0.2  # for the last messages to be sent before the session closes


EPILOG = """\
examples:
  tailor replay run.mcap --rate 2 --start 10 --duration 5
  tailor replay run.mcap --topics 'odom,pose' --remap agilo/odom=ghost/odom
  tailor replay run.mcap --clock 100                 (for ROS 2 nodes with use_sim_time)
  tailor replay run.mcap --substitute executive      (tailor bus --security open, and tailor executive, run before)

A bus must run: tailor bus. `tailor view` needs none."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor replay`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    add = parser.add_argument
    add("file", help="recording (MCAP)")
    add("--rate", type=float, default=1.0, metavar="X", help=f"recorded s per s, {MIN_RATE:g} to {MAX_RATE:g}")
    add("--start", type=float, default=0.0, metavar="S", help="begin this long after the first message")
    add("--duration", type=float, default=0.0, metavar="S", help="end after this much recorded time")
    add("--loop", action="store_true", help="repeat until stopped")
    configure_selection(parser)
    add("--remap", action="append", default=[], metavar="OLD=NEW", help="replace a key, e.g. agilo/odom=ghost/odom")
    add("--clock", type=float, default=0.0, metavar="HZ", help="publish the recorded time on /clock")
    add("--paused", action="store_true", help="begin paused")
    add("--wait", type=float, default=2.0, metavar="S", help="wait this long for subscribers (default 2)")
    add(
        "--drive",
        action="store_true",
        help="publish commands, requests and driver states even if a driver is live; needs an open bus",
    )
    add(
        "--substitute",
        choices=SUBSTITUTES,
        help="replace the recorded messages of this process by a live one; needs an open bus",
    )
    add("--json", action="store_true", help="print the result as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Play to the end; 0, or 1 if the bus disconnected."""
    if not MIN_RATE <= arguments.rate <= MAX_RATE:
        raise UsageError(f"--rate is {arguments.rate:g}, expected {MIN_RATE:g} to {MAX_RATE:g}")
    for name, maximum in (("start", MAX_S), ("duration", MAX_S), ("wait", MAX_S), ("clock", MAX_CLOCK_HZ)):
        check_within(getattr(arguments, name), maximum, f"--{name}")
    recording, remap = open_recording(arguments.file), remapping(arguments.remap)
    wanted = selection(arguments.topics, arguments.exclude)
    secured = _is_secured(arguments)
    if secured and (arguments.drive or arguments.substitute):
        raise UsageError(f"{'--drive' if arguments.drive else f'--substitute {arguments.substitute}'}: {SECURED}")
    with open_bus(arguments, "player") as session:
        codec.prime()
        changes: dict[str, Any] = {}
        if arguments.substitute:
            wanted = Selection(wanted.include, wanted.exclude + OMITTED)
            changes = {"rewrite": partial(armed_for, live_executive(session))}
        elif reason := _why_not_drive(arguments, secured, session):
            _warn(f"{reason}: commands, arming requests, e-stops and states of drivers are omitted")
            wanted = Selection(wanted.include, wanted.exclude + OF_ROBOTS)
            changes = {"excluded_keys": Selection(exclude=OF_ROBOTS)}
        part = RecordingPart(recording, wanted, remap, arguments.start, arguments.duration, **changes)
        if secured:
            part = part.playable()
            if part.left_out:
                _warn(f"on a secured bus nobody replays {', '.join(sorted(part.left_out))}; omitted")
        publishers = Publishers(session, part.channels())
        damage = recording.damage.text()  # all of it has been read; the playback may end early
        stats, disconnected = _play(arguments, session, part, publishers)
        _report(stats, arguments.json)  # a session whose router hangs takes seconds to close
        if damage:
            _warn(f"{recording.path}: {damage}")
        if disconnected:
            _warn("bus disconnected: the replay ended early")
        return int(disconnected)


def _play(
    arguments: argparse.Namespace, session: Session, part: RecordingPart, publishers: Publishers
) -> tuple[PlaybackStats, bool]:
    """What was played, and whether the bus has ended it: not where people did so before."""
    clock = MonotonicClock()
    unmatched = publishers.wait(arguments.wait)
    if unmatched:
        _warn(f"no subscriber of: {', '.join(unmatched)}")
    stop = stop_on_signals()  # not earlier: until here, where a signal may end all at once, nothing looks at it
    with Keyboard() as keyboard:

        def watch(playback: PlaybackClock) -> bool:
            return session.connected and not stop.requested and _steer(playback, keyboard.pressed(), clock.now_ns())

        def tick(recorded_ns: int) -> None:
            clock_publisher.publish(Clock(min(recorded_ns, LAST_CLOCK_NS)))

        clock_publisher = session.publisher("clock", "")
        tick_ns = round(1e9 / arguments.clock) if arguments.clock else 0
        player = Player(publishers, clock, watch, tick, tick_ns)
        start_ns, _ = part.bounds_ns()
        playback = PlaybackClock(start_ns, clock.now_ns(), arguments.rate, arguments.paused)
        while player.play(part.messages(), playback) and arguments.loop:
            playback.jump(start_ns, clock.now_ns())
    stopped = stop.requested
    time.sleep(TAIL_S)
    return player.stats, not (session.connected or stopped)


def _steer(playback: PlaybackClock, key: str, now_ns: int) -> bool:
    """Apply a key to the playback; False ends the replay."""
    if key == "space":
        playback.toggle(now_ns)
    elif key == "right":
        playback.step()
    elif key in ("up", "down"):
        playback.scale(1.1 if key == "up" else 1 / 1.1, now_ns)
    return key != "quit"


def _why_not_drive(arguments: argparse.Namespace, secured: bool, session: Session) -> str:
    """Reason for omitting what drives a robot or passes for its driver; empty: it is published."""
    if secured:
        return SECURED
    if not arguments.drive and _driver_is_live(session):
        return "a driver is live (--drive publishes all)"
    return ""


def _is_secured(arguments: argparse.Namespace) -> bool:
    """Whether the bus runs with passwords here, or is another machine's that demands a key."""
    settings = bus_settings(arguments)
    return bool(settings.key) or run_folder(settings.endpoint).secured


def _driver_is_live(session: Session) -> bool:
    queue, subscription = session.subscribe_all(TOPICS["driver"].key.format(robot="*"))
    time.sleep(LISTEN_S)
    subscription.undeclare()
    return bool(queue.drain())


def _report(stats: PlaybackStats, as_json: bool) -> None:
    late_ms = np.array(stats.lateness_ns or [0]) / 1e6
    p50, p99, worst = (float(np.percentile(late_ms, q)) for q in (50, 99, 100))
    if as_json:
        figures = {"p50_ms": round(p50, 3), "p99_ms": round(p99, 3), "max_ms": round(worst, 3)}
        print(json.dumps({"messages": stats.messages, "bytes": stats.bytes, "lateness": figures}), flush=True)
    else:
        line = f"{stats.messages} messages, late by p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {worst:.2f} ms"
        print(line, flush=True)


def _warn(line: str) -> None:
    print(line, file=sys.stderr)
