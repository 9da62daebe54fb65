"""The drawing of a system's state, the stop key, and the part of a flood that is read."""

import time
from dataclasses import replace
from io import StringIO
from threading import Event, Semaphore

from rich.console import Console
from rich.style import Style

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.schemas.messages import EStop, Odometry, ProcessState, ProcessStates
from tailor.tools.status.panel import BAD, panel
from tailor.tools.status.stop_key import StopKey
from tailor.tools.status.system_model import SystemModel
from tailor.tools.status.watcher import MAX_OF_KEY, MAX_READ, Watcher
from tests.support.patience import PATIENCE_S
from tests.unit.tools.status.bus_feed import OTHER, Feed, driver, raw_of, status

ENDPOINT = "tcp/127.0.0.1:7447"


def drawn(picture, width=120):
    console = Console(width=width, file=StringIO(), markup=False, highlight=False)
    console.print(panel(picture, ENDPOINT))
    return [line.rstrip() for line in console.file.getvalue().splitlines()]


def marked(picture):
    """Texts that are drawn as bad."""
    segments = Console(width=120, file=StringIO()).render(panel(picture, ENDPOINT))
    return {text.strip() for text, style, _ in segments if style is not None and style == Style.parse(BAD)} - {""}


class SlowButton:
    """A button whose press lasts until the test releases it."""

    def __init__(self):
        self.begun, self.released, self.connected = Semaphore(0), Event(), True

    def press(self):
        self.begun.release()
        assert self.released.wait(PATIENCE_S)


def test_the_verdict_comes_first_and_every_part_has_its_line():
    lines = drawn(Feed().run(2.0))
    assert lines[0] == f"healthy   {ENDPOINT}, observed for 2 s"
    text = "\n".join(lines)
    for part in ("executive abababab  EXECUTING", "1.0 of 5.0 s predicted", "20 in the last 2 s, 0 skipped"):
        assert part in text
    (row,) = [line.split() for line in lines if line.startswith("agilo  ")]
    assert row == ["agilo", "armed", "abababab", "(executive)", "00000007", "5", "2", "other", "sender", "0.10"]
    (row,) = [line.split() for line in lines if line.startswith("agilo/odom")]
    assert row == ["agilo/odom", "50.0", "50", "0.02", "0.5", "100", "1"]


def test_processes_are_listed_or_missing():
    feed = Feed()
    assert "not launched by tailor up" in drawn(feed.run(1.0))
    feed.put("processes", ProcessStates(0, (ProcessState("sim", 17, "running", 1, 0.1, "", OTHER),)))
    (row,) = [line.split() for line in drawn(feed.run(1.0)) if line.startswith("sim ")]
    assert row == ["sim", "running", "17", "1", "0.1"]


def test_problems_stand_below_the_verdict():
    picture = Feed().run(2.0, driver=driver("stopped", "driver fault", ""), status=status("FAULT", "repeated failure"))
    assert [line.strip() for line in drawn(picture)[:3]] == [
        f"2 problems   {ENDPOINT}, observed for 2 s",
        "driver stopped: agilo: driver fault",
        "executive fault: repeated failure",
    ]


def test_figures_that_are_wrong_are_marked():
    picture = Feed().run(2.0)
    assert marked(picture) == set()
    (driver_view,), (odom, *others) = picture.drivers, sorted(picture.topics, key=lambda each: each.key != "agilo/odom")
    wrong = {
        "3": {"topics": (replace(odom, senders=3), *others)},
        "9.5": {"topics": (replace(odom, rate_hz=9.5, slow=True), *others)},
        "7.25": {"topics": (replace(odom, age_s=7.25, stale=True), *others)},
        "abababab (absent)": {"drivers": (replace(driver_view, armed_for="absent"),)},
    }
    assert {figure: marked(replace(picture, **changes)) for figure, changes in wrong.items()} == {
        figure: {figure} for figure in wrong
    }


def test_text_from_the_bus_cannot_control_the_terminal():
    feed = Feed()
    feed.raw(raw_of("junk\x1b[2J", EStop(True)))
    text = "\n".join(drawn(feed.run(2.0, status=status("FAULT", "[red]\x1b[31mx", "\n\n"))))
    assert "\x1b" not in text
    assert "[red]\\x1b[31mx: \\n\\n" in text
    assert "not ours: junk\\x1b[2J 1" in text


def test_an_empty_bus_is_drawn_too():
    assert drawn(Feed().picture())[0] == f"2 problems   {ENDPOINT}, observed for 0 s"


def test_each_press_stops_without_waiting_for_an_earlier_one():
    button = SlowButton()
    key = StopKey(button)
    key.poll(b"")
    key.poll(b"xq")
    assert not button.begun.acquire(blocking=False)
    for keys in (b"s", b" ", b"\x1b[As"):
        key.poll(keys)
        assert button.begun.acquire(timeout=PATIENCE_S), "also among other keys"
    for _ in range(100):
        key.poll(b"s")
    assert button.begun.acquire(timeout=PATIENCE_S)
    assert not button.begun.acquire(blocking=False), "presses that wait are bounded"
    button.released.set()
    key.finish()
    key.poll(b"s")
    assert button.begun.acquire(timeout=PATIENCE_S)
    key.finish()


def test_the_line_of_the_stop_key_shows_what_became_of_it():
    button = SlowButton()
    button.released.set()
    key = StopKey(button)
    healthy, stopped = Feed().run(1.0), Feed().run(1.0, driver=driver("estopped", "e-stop", ""))
    assert "pressed" not in key.line(healthy, keyboard=True).plain
    assert key.line(healthy, keyboard=False).plain == "no keyboard: no emergency stop from here"
    key.poll(b"s")
    key.finish()
    assert key.line(stopped, keyboard=True).plain.endswith("pressed: agilo is estopped")
    unheard = "pressed: NOT CONFIRMED: no driver is heard on the bus"
    assert key.line(Feed().picture(), keyboard=True).plain.endswith(unheard)


def test_what_a_driver_confirmed_before_it_fell_silent_is_not_shown_as_its_mode():
    button = SlowButton()
    button.released.set()
    key, feed = StopKey(button), Feed()
    key.poll(b"s")
    key.finish()
    feed.run(1.0, driver=driver("estopped", "e-stop", ""))
    feed.now_s = 4.0
    assert key.line(feed.picture(), keyboard=True).plain.endswith("pressed: agilo is silent")
    button.connected = False
    assert "NOT CONFIRMED: the bus is lost" in key.line(feed.picture(), keyboard=True).plain


def test_a_press_that_no_bus_has_heard_is_repeated_once_when_it_is_back():
    button = SlowButton()
    button.released.set()
    key, presses = StopKey(button), 0
    for connected, keys, expected in (
        (True, b"s", 1),
        (True, b"", 1),
        (False, b"", 1),
        (False, b"s", 2),
        (False, b"x", 2),
        (True, b"", 3),
        (True, b"", 3),
    ):
        button.connected = connected
        key.poll(keys)
        key.finish()
        while button.begun.acquire(blocking=False):
            presses += 1
        assert presses == expected


def test_a_topic_that_is_published_on_change_has_no_rate():
    feed = Feed()
    for _ in range(3):
        feed.put("estop", EStop(False))
    picture = feed.run(7.0)
    topic = next(topic for topic in picture.topics if topic.key == "estop")
    assert (topic.published, topic.rate_hz, topic.received) == ("on change", None, 3)
    (row,) = [line.split() for line in drawn(picture) if line.startswith("estop ")]
    assert row[:3] == ["estop", "on", "change"]
    assert next(topic for topic in picture.topics if topic.key == "agilo/odom").published == "periodically"


def test_of_a_flood_a_part_is_read_so_that_keys_are_noticed():
    queue, model = IngestQueue(), SystemModel(0)
    watcher = Watcher(queue, model, 0)
    odometry = Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2)
    for k in range(20_000):
        queue.put(raw_of("agilo/odom", odometry, sequence=k + 1))
    queue.put(raw_of("agilo/driver", driver()))
    for k in range(2 * MAX_READ):
        queue.put(raw_of(f"junk/{k}", odometry))
    began = time.process_time()
    watcher.poll(1)
    assert time.process_time() - began < 1.0
    picture = model.picture(1)
    assert {topic.key: topic.received for topic in picture.topics} == {"agilo/driver": 1, "agilo/odom": MAX_OF_KEY}
    assert picture.foreign.dropped == 20_000 + 1 + 2 * MAX_READ - MAX_READ
