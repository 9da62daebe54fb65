"""Play a recording on the bus at its recorded times: same bytes, same numbers, same senders.

Keys: space pauses and goes on, right (or s) sends the next message while paused, up and down change the rate, q ends.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from functools import partial
from typing import Any

import numpy as np

from tailor.runtime.bus.session import Session, open_client
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.recordings.playback_clock import FASTEST, SLOWEST, PlaybackClock
from tailor.runtime.recordings.player import Played, Player
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.selection import Selection, selection
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Clock
from tailor.schemas.topics import TOPICS
from tailor.tools.cli.endpoint import configure_bus, endpoint_of
from tailor.tools.cli.keyboard import Keyboard
from tailor.tools.cli.number_checks import check_within
from tailor.tools.recordings.playback import Outlets, Passage, remapping
from tailor.tools.recordings.substitution import SILENCED, SUBSTITUTES, armed_for, live_executive

DRIVING = ("arm_request", "estop", *(name for name, t in TOPICS.items() if t.priority == "real_time"))
LISTEN_S = 0.5  # for a live driver; they speak at 10 Hz
MAX_S = 1e9  # a recording has no such length
FASTEST_CLOCK_HZ = 10_000.0
LAST_CLOCK_NS = (2**31 - 1) * 10**9  # ROS's clock ends in 2038
TAIL_S = 0.2  # for the last messages to leave before the session closes


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor replay`."""
    add = parser.add_argument
    add("file", help="recording (MCAP)")
    add("--rate", type=float, default=1.0, metavar="X", help=f"recorded seconds per second, {SLOWEST:g} to {FASTEST:g}")
    add("--start", type=float, default=0.0, metavar="S", help="begin so long after the first message")
    add("--duration", type=float, default=0.0, metavar="S", help="end after so much recorded time")
    add("--loop", action="store_true", help="again and again")
    add("--topics", action="append", default=[], metavar="WORDS", help="only these: odom, 'agilo/*', a ROS type; a,b,c")
    add("--exclude", action="append", default=[], metavar="WORDS", help="all but these")
    add("--remap", action="append", default=[], metavar="OLD=NEW", help="another key, e.g. agilo/odom=ghost/odom")
    add("--clock", type=float, default=0.0, metavar="HZ", help="publish the recorded time on /clock")
    add("--paused", action="store_true", help="begin paused")
    add("--wait", type=float, default=2.0, metavar="S", help="wait so long for somebody to listen (default 2)")
    add("--drive", action="store_true", help="send commands and arming requests even to a live driver")
    add("--substitute", choices=SUBSTITUTES, help="leave out what this one said, and let a live one answer")
    add("--json", action="store_true", help="tell the result as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Play until the end; 0, or 1 when the bus went away."""
    if not SLOWEST <= arguments.rate <= FASTEST:
        raise UsageError(f"--rate is {arguments.rate:g}, expected {SLOWEST:g} to {FASTEST:g}")
    for name, most in (("start", MAX_S), ("duration", MAX_S), ("wait", MAX_S), ("clock", FASTEST_CLOCK_HZ)):
        check_within(getattr(arguments, name), most, f"--{name}")
    recording, remap = open_recording(arguments.file), remapping(arguments.remap)
    wanted = selection(arguments.topics, arguments.exclude)
    stop = stop_on_signals()
    with open_client(endpoint_of(arguments)) as session:
        codec.prime()
        changes: dict[str, Any] = {}
        if arguments.substitute:
            wanted = Selection(wanted.include, wanted.exclude + SILENCED)
            changes = {"rewrite": partial(armed_for, live_executive(session))}
        elif not arguments.drive and _driver_is_live(session):
            _say("a driver is live: commands, arming requests and e-stops are left out (--drive sends them)")
            wanted = Selection(wanted.include, wanted.exclude + DRIVING)
            changes = {"barred": Selection(exclude=DRIVING)}
        passage = Passage(recording, wanted, remap, arguments.start, arguments.duration, **changes)
        outlets = Outlets(session, passage.places())
        damage = recording.damage.text()  # now that all of it was read once; what follows may end early
        played = _play(arguments, session, passage, outlets, stop)
        gone = not session.connected
    _tell(played, arguments.json)
    if damage:
        _say(f"{recording.path}: {damage}")
    if gone:
        _say("the bus is gone: the replay ended early")
    return int(gone)


def _play(arguments: argparse.Namespace, session: Session, passage: Passage, outlets: Outlets, stop: Stop) -> Played:
    clock = MonotonicClock()
    deaf = outlets.wait(arguments.wait)
    if deaf:
        _say(f"nobody listens to: {', '.join(deaf)}")
    with Keyboard() as keyboard:

        def watch(playback: PlaybackClock) -> bool:
            return session.connected and not stop.requested and _steer(playback, keyboard.pressed(), clock.now_ns())

        def tick(recorded_ns: int) -> None:
            clock_outlet.publish(Clock(min(recorded_ns, LAST_CLOCK_NS)))

        clock_outlet = session.publisher("clock", "")
        tick_ns = round(1e9 / arguments.clock) if arguments.clock else 0
        player = Player(outlets, clock, watch, tick, tick_ns)
        start_ns, _ = passage.bounds_ns()
        again = True
        while again:
            playback = PlaybackClock(start_ns, clock.now_ns(), arguments.rate, arguments.paused)
            again = player.play(passage.messages(), playback) and arguments.loop
    time.sleep(TAIL_S)
    return player.played


def _steer(playback: PlaybackClock, key: str, now_ns: int) -> bool:
    """Do what a key says; False ends the replay."""
    if key == "space":
        playback.toggle(now_ns)
    elif key == "right":
        playback.step()
    elif key in ("up", "down"):
        playback.scale(1.1 if key == "up" else 1 / 1.1, now_ns)
    return key != "quit"


def _driver_is_live(session: Session) -> bool:
    intake, subscribe_all = session.subscribe_all(TOPICS["driver"].key.format(robot="*"))
    time.sleep(LISTEN_S)
    subscribe_all.undeclare()
    return bool(intake.drain())


def _tell(played: Played, as_json: bool) -> None:
    late_ms = np.array(played.lateness_ns or [0]) / 1e6
    p50, p99, worst = (float(np.percentile(late_ms, q)) for q in (50, 99, 100))
    if as_json:
        figures = {"p50_ms": round(p50, 3), "p99_ms": round(p99, 3), "max_ms": round(worst, 3)}
        print(json.dumps({"messages": played.messages, "bytes": played.bytes, "lateness": figures}))
    else:
        print(f"{played.messages} messages, late by p50 {p50:.2f} ms, p99 {p99:.2f} ms, max {worst:.2f} ms")


def _say(line: str) -> None:
    print(line, file=sys.stderr)
