"""A part that was heard and is silent is an event, in a recording and on the live page; what it published is past."""

from __future__ import annotations

from tailor.schemas import messages as m
from tailor.schemas.topics import STALE_S
from tailor.tools.viewer.timeline import RunTimeline

STATUS = m.ExecStatus(0, 1, "EXECUTING", "", "", "", "", "", 0, 0.0, 0.0)
DRIVER = m.DriverState(0, "armed", "", "", 1, "", 0)


def silent_events(timeline: RunTimeline, *published: tuple[float, str, m.Message]) -> list:
    events = [event for at_s, key, message in published for event in timeline.events_of(at_s, key, message)]
    return [(event.at_s, event.fields) for event in events if event.kind == "silent"]


def test_a_killed_executive_beside_a_driver_that_lives_is_silent_until_it_publishes_again() -> None:
    lives = [(at_s, "agilo/driver", DRIVER) for at_s in (0.3, 0.58, 0.65, 0.9)]
    events = silent_events(RunTimeline(), (0.1, "exec/status", STATUS), *lives, (1.1, "exec/status", STATUS))
    assert events == [(0.65, {"executive": 0.1}), (1.1, {})]


def test_without_any_message_time_alone_reveals_the_silence_of_both() -> None:
    timeline = RunTimeline()
    silent_events(timeline, (0.0, "exec/status", STATUS), (0.2, "agilo/driver", DRIVER))
    assert timeline.silences(STALE_S) == []
    assert [event.fields for event in timeline.silences(STALE_S + 0.01)] == [{"executive": 0.0}]
    assert [event.fields for event in timeline.silences(9.0)] == [{"executive": 0.0, "driver": 0.2}]
    assert timeline.silences(10.0) == [], "once"


def test_both_are_silent_in_a_recording_while_it_has_no_message_at_all() -> None:
    """The first message after it came too late to tell, and that of the driver told nothing of the driver."""
    both = [(0.0, "exec/status", STATUS), (0.2, "agilo/driver", DRIVER)]
    events = silent_events(RunTimeline(), *both, (25.0, "agilo/driver", DRIVER), (25.1, "exec/status", STATUS))
    (begin_s, silent), *others = events
    assert 0.2 + STALE_S < begin_s < 0.2 + STALE_S + 0.05
    assert silent == {"executive": 0.0, "driver": 0.2}
    assert others == [(25.0, {"executive": 0.0}), (25.1, {})]


def test_what_was_never_heard_is_not_silent() -> None:
    assert RunTimeline().silences(99.0) == []


def test_the_driver_of_another_robot_neither_speaks_nor_falls_silent_for_this_one() -> None:
    timeline = RunTimeline(robot="agilo")
    assert silent_events(timeline, (0.0, "agilo/driver", DRIVER), (0.4, "b21/driver", DRIVER)) == []
    assert [event.fields for event in timeline.silences(0.6)] == [{"driver": 0.0}]
    assert silent_events(RunTimeline(robot="agilo"), (0.0, "b21/driver", DRIVER), (9.0, "exec/status", STATUS)) == []
