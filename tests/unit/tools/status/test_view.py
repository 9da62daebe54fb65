"""The drawing of a system's state, the stop key, and the part of a flood that is read."""

import time
from io import StringIO

from rich.console import Console

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.schemas.messages import EStop, Odometry, ProcessState, ProcessStates
from tailor.tools.status.panel import panel
from tailor.tools.status.stop_key import LASTING_NS, REPEAT_NS, StopKey
from tailor.tools.status.system_model import SystemModel
from tailor.tools.status.watcher import MAX_OF_KEY, MAX_READ, Watcher
from tests.unit.tools.status.bus_feed import OTHER, Feed, driver, raw_of, status

ENDPOINT = "tcp/127.0.0.1:7447"


def drawn(picture, width=120):
    console = Console(width=width, file=StringIO(), markup=False, highlight=False)
    console.print(panel(picture, ENDPOINT))
    return [line.rstrip() for line in console.file.getvalue().splitlines()]


class Published:
    def __init__(self):
        self.messages = []

    def publish(self, message):
        self.messages.append(message)


def test_the_verdict_comes_first_and_every_part_has_its_line():
    lines = drawn(Feed().run(2.0))
    assert lines[0] == f"healthy   {ENDPOINT}, observed for 2 s"
    text = "\n".join(lines)
    for part in ("executive abababab  EXECUTING", "1.0 of 5.0 s predicted", "20 in the last minute, 0 skipped"):
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


def test_text_from_the_bus_cannot_control_the_terminal():
    feed = Feed()
    feed.raw(raw_of("junk\x1b[2J", EStop(True)))
    text = "\n".join(drawn(feed.run(2.0, status=status("FAULT", "[red]\x1b[31mx", "\n\n"))))
    assert "\x1b" not in text
    assert "[red]\\x1b[31mx: \\n\\n" in text
    assert "not ours: junk\\x1b[2J 1" in text


def test_an_empty_bus_is_drawn_too():
    assert drawn(Feed().picture())[0] == f"2 problems   {ENDPOINT}, observed for 0 s"


def test_a_press_publishes_the_estop_again_and_again_for_three_seconds():
    published = Published()
    key = StopKey(published)
    key.poll(b"", 0)
    assert published.messages == []
    key.poll(b"xxs", 1)
    assert published.messages == [EStop(True)], "at once, also among other keys"
    for step in range(1, 200):
        key.poll(b"", 1 + step * REPEAT_NS)
    assert published.messages == [EStop(True)] * (1 + LASTING_NS // REPEAT_NS)
    key.poll(b" ", 200 * REPEAT_NS)
    assert len(published.messages) == 2 + LASTING_NS // REPEAT_NS


def test_the_line_of_the_stop_key_shows_what_became_of_it():
    key = StopKey(Published())
    healthy, stopped = Feed().run(1.0), Feed().run(1.0, driver=driver("estopped", "e-stop", ""))
    assert "pressed" not in key.line(healthy, keyboard=True).plain
    assert key.line(healthy, keyboard=False).plain == "no keyboard: no emergency stop from here"
    key.poll(b"s", 0)
    assert key.line(stopped, keyboard=True).plain.endswith("pressed: agilo is estopped")
    assert key.line(Feed().picture(), keyboard=True).plain.endswith("pressed: no driver is on the bus")


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
