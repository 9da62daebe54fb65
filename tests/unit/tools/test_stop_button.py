"""The e-stop of the command line, the page and the dead man's switch, with a bus that only counts."""

import json
import os
import sys
import time
from contextlib import contextmanager, nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.schemas.codec import encode
from tailor.schemas.errors import UnreachableError
from tailor.schemas.messages import DriverState, EStop
from tailor.tools.commands.run import estop
from tailor.tools.main import main
from tailor.tools.operator import dead_mans_switch, stop_button
from tailor.tools.operator.dead_mans_switch import HELD, DeadMansSwitch, driver_lines
from tailor.tools.operator.stop_button import STOP, StopButton, all_stopped, summary

SENDER = "ab12cd34" + "0" * 24


def state(mode="armed", reason="", detail="", epoch=1):
    return DriverState(0, mode, reason, detail, epoch, "", 0)


class Bus:
    """A session whose drivers, by robot, answer every e-stop with `reaction(number of e-stops)`."""

    sender = SENDER

    def __init__(self, **drivers):
        self.drivers, self.sent, self.connected = drivers, [], True
        self.queue = None

    def publisher(self, name, robot):
        assert (name, robot) == ("estop", "")
        return self

    def publish_encoded(self, payload):
        self.sent.append(payload)
        for robot, reaction in self.drivers.items():
            heard = reaction(len(self.sent))
            if heard is not None and self.queue is not None:
                self.queue.put(Raw(f"{robot}/driver", heard, None, "", True, None))

    def subscribe_all(self, pattern):
        assert pattern == "*/driver"
        self.queue = IngestQueue()
        return self.queue, self

    def undeclare(self):
        self.queue = None


def confirms(after=1):
    return lambda count: encode(state("estopped" if count > after else "armed"))


def test_the_prepared_bytes_are_those_of_the_codec():
    assert (encode(EStop(True)), encode(EStop(False))) == (STOP, HELD)


def test_the_button_is_pressed_until_every_driver_confirms():
    bus = Bus(agilo=confirms(3), nomad=confirms(40))
    states = StopButton(bus).press(20.0)
    assert len(bus.sent) > 40
    assert set(bus.sent) == {STOP}
    assert all_stopped(states)
    assert summary(states) == "agilo is estopped\nnomad is estopped"
    assert bus.queue is None, "the subscription ends with the press"


def test_the_button_listens_long_enough_to_hear_every_driver():
    began_s = time.monotonic()

    def late(count):
        return encode(state("armed")) if time.monotonic() > began_s + 0.3 else None

    assert summary(StopButton(Bus(agilo=confirms(), nomad=late)).press(1.0)) == "agilo is estopped\nnomad is armed"


@pytest.mark.parametrize("drivers", [{}, {"agilo": confirms(10**6)}, {"agilo": lambda count: b"junk"}])
def test_without_a_confirmation_the_button_gives_up_in_time_and_reports_it(drivers, monkeypatch):
    states = StopButton(Bus(**drivers)).press(0.4)
    assert not all_stopped(states)
    assert summary(states) == ("agilo is armed" if states else "no driver is on the bus")


def test_an_expected_driver_that_is_silent_has_not_stopped():
    bus = Bus(agilo=confirms())
    states = StopButton(bus).press(0.6, ["agilo", "nomad"])
    assert all_stopped(states)
    assert not all_stopped(states, ["nomad", "agilo"])
    assert summary(states, ["nomad"]) == "agilo is estopped\nnomad is SILENT: its state is unknown"
    assert summary({}, ["nomad"]) == "nomad is SILENT: its state is unknown"


def test_an_expected_driver_is_awaited():
    began_s = time.monotonic()

    def late(count):
        return encode(state("estopped")) if time.monotonic() > began_s + 0.6 else None

    states = StopButton(Bus(agilo=confirms(), nomad=late)).press(5.0, ["nomad"])
    assert all_stopped(states, ["agilo", "nomad"])


@pytest.mark.parametrize(("expected", "code"), [((), 0), (("agilo",), 0), (("agilo", "nomad"), 1), (("agillo",), 1)])
def test_the_command_is_done_if_those_that_it_expects_have_stopped(monkeypatch, capsys, expected, code):
    monkeypatch.setattr(estop, "open_bus", lambda *_: nullcontext(Bus(agilo=confirms())))
    assert main(["estop", "--json", *(("--expect", *expected) if expected else ())]) == code
    assert json.loads(capsys.readouterr().out) == {"stopped": code == 0, "drivers": {"agilo": "estopped"}}


@pytest.mark.parametrize(
    ("drivers", "shown"), [({}, ""), ({"agilo": lambda count: encode(state())}, "agilo is armed\n")]
)
def test_an_estop_whose_bus_is_lost_is_not_told_that_no_driver_is_there(monkeypatch, capsys, drivers, shown):
    """Behind a router that hung, nobody was heard, nor had heard it: `no driver is on the bus`."""
    bus = Bus(**drivers)
    bus.connected = False
    monkeypatch.setattr(estop, "open_bus", lambda *_: nullcontext(bus))
    assert main(["estop"]) == 1
    printed = capsys.readouterr()
    assert printed.out == shown
    assert printed.err.startswith("NOT CONFIRMED: the bus was lost")


def test_an_estop_reports_before_its_session_closes(monkeypatch, capsys):
    """A session whose router hangs took up to ten seconds, in which nobody read NOT CONFIRMED."""
    read = []

    @contextmanager
    def closing(*_):
        yield Bus(agilo=confirms())
        read.append(capsys.readouterr().out)

    monkeypatch.setattr(estop, "open_bus", closing)
    assert main(["estop"]) == 0
    assert read == ["agilo is estopped\n"]


def test_who_presses_while_no_bus_answers_is_told_at_once_to_use_another_stop(monkeypatch, capsys):
    """For 3 s nothing was printed, and then that a bus is to be started."""
    read = []

    @contextmanager
    def unreachable(*_):
        end_s = time.monotonic() + 5.0
        while not read and time.monotonic() < end_s:
            read.extend(capsys.readouterr().err.splitlines())
            time.sleep(0.01)
        raise UnreachableError("bus endpoint tcp/x: no router responds")
        yield

    monkeypatch.setattr(estop, "open_bus", unreachable)
    assert main(["estop"]) == 2
    assert read == ["NOT STOPPED: use the e-stop of the robot itself; no bus answers so far"]
    error = "tailor estop: bus endpoint tcp/x: no router responds; NOT STOPPED: use the e-stop of the robot itself\n"
    assert capsys.readouterr().err == error


def test_where_a_bus_answers_in_time_nobody_reads_that_nothing_was_stopped(monkeypatch, capsys):
    monkeypatch.setattr(estop, "PATIENCE_S", 0.2)
    monkeypatch.setattr(estop, "open_bus", lambda *_: nullcontext(Bus(agilo=confirms(40))))
    assert main(["estop"]) == 0
    assert capsys.readouterr().err == ""


def test_a_newer_state_counts_and_junk_does_not():
    queue = IngestQueue()
    states = stop_button.DriverStates(queue)
    for payload in (encode(state("estopped")), encode(state("armed")), b"junk"):
        queue.put(Raw("agilo/driver", payload, None, "", True, None))
    queue.put(Raw("agilo/driver", encode(state("estopped")), None, "", False, None))
    assert states.poll() == {"agilo"}
    assert states.poll() == set()
    assert states.newest["agilo"].mode == "armed"


@pytest.mark.promise("P45")
def test_of_several_drivers_of_a_robot_none_confirms_the_stop_of_another():
    """`agilo is estopped`, with exit code 0, while the robot's own driver was armed beside a forgotten simulator."""
    queue, now_s = IngestQueue(), [0.0]
    states = stop_button.DriverStates(queue, lambda: now_s[0])

    def hear(**modes):
        for sender, mode in modes.items():
            attachment = pack(Origin(1, 0, sender * 32))
            queue.put(Raw("agilo/driver", encode(state(mode)), attachment, "", True, None))
        states.poll()

    for order in ({"a": "armed", "b": "estopped"}, {"b": "estopped", "a": "armed"}):
        hear(**order)
        assert not all_stopped(states.newest)
        assert summary(states.newest) == "agilo is armed"
    hear(b="estopped")
    assert not all_stopped(states.newest), "the other one may have frozen"
    hear(a="estopped")
    assert all_stopped(states.newest)
    hear(a="armed")
    for now_s[0] in (1.0, 2.0, 3.0):
        hear(b="estopped")
    assert all_stopped(states.newest), "one that is silent has started anew; nothing grows"
    assert len(states.all()["agilo"]) == 1


def test_a_robot_that_has_fallen_silent_keeps_its_last_state():
    queue, now_s = IngestQueue(), [0.0]
    states = stop_button.DriverStates(queue, lambda: now_s[0])
    for robot, now_s[0] in (("agilo", 0.0), ("nomad", 9.0)):
        queue.put(Raw(f"{robot}/driver", encode(state()), None, "", True, None))
        states.poll()
    assert summary(states.newest) == "agilo is armed\nnomad is armed"


def test_a_switch_that_one_of_several_drivers_does_not_hear_is_reported():
    lines = []
    bus = Bus()
    switch = DeadMansSwitch(bus, lines.append)
    hears, deaf = state(detail="held by ab12cd34"), state("disarmed", epoch=2)
    for each in ([hears, deaf], [deaf, hears]):
        switch._show(SimpleNamespace(all=lambda each=each: {"agilo": each}), 0)
    assert lines == ["agilo is disarmed: DOES NOT HEAR THIS SWITCH"]


def test_a_switch_is_held_ten_times_a_second_until_it_is_released():
    bus = Bus()
    DeadMansSwitch(bus, print).hold(lambda: len(bus.sent) >= 4)
    assert bus.sent == [HELD] * 4


def test_a_switch_without_bus_ends_and_reports_it():
    bus, lines = Bus(), []
    bus.connected = False
    DeadMansSwitch(bus, lines.append).hold(lambda: len(bus.sent) > 20)
    assert 5 <= len(bus.sent) <= 8
    assert "drivers have stopped" in lines[-1]


@pytest.mark.parametrize(
    ("driver", "expected"),
    [
        (state(detail="held by 11111111, ab12cd34"), "agilo is armed: hears this switch"),
        (state(detail="held by 11111111"), "agilo is armed: DOES NOT HEAR THIS SWITCH"),
        (state(detail="ab12cd34"), "agilo is armed (ab12cd34): DOES NOT HEAR THIS SWITCH"),
        (
            state("disarmed", "disarm request", "by 22222222; held by ab12cd34"),
            "agilo is disarmed (disarm request: by 22222222): hears this switch",
        ),
        (state("stopped", "x\x1b[2J"), "agilo is stopped (x\\x1b[2J): DOES NOT HEAR THIS SWITCH"),
    ],
)
def test_a_line_tells_whether_the_driver_hears_the_switch(driver, expected):
    assert driver_lines({"agilo": driver}, "ab12cd34", set()) == {"agilo": expected}


def test_a_driver_that_falls_silent_is_reported():
    lines = driver_lines({"agilo": state(detail="held by ab12cd34")}, "ab12cd34", {"agilo"})
    assert lines == {"agilo": "agilo is SILENT: its state is unknown"}


@pytest.mark.parametrize("way", ["nothing to read", "a line", "its end", "closed", "none"])
def test_a_switch_is_held_only_while_standard_input_is_open_and_silent(monkeypatch, way):
    read, write = os.pipe()
    with open(read) as terminal, open(write, "w") as keys:
        if way == "a line":
            keys.write("x\n")
        if way in ("a line", "its end"):
            keys.close()
        if way == "closed":
            terminal.close()
        monkeypatch.setattr(sys, "stdin", None if way == "none" else terminal)
        assert dead_mans_switch._readable() is (way != "nothing to read")


def test_what_people_read_of_a_held_switch_is_no_part_of_the_json(monkeypatch, capsys):
    class Switch:
        def __init__(self, session, report):
            self.report = report

        def hold(self, released):
            self.report("agilo is armed: hears this switch")

    monkeypatch.setattr(estop, "open_bus", lambda *_: nullcontext(SimpleNamespace(connected=True)))
    monkeypatch.setattr(estop, "StopButton", lambda session: SimpleNamespace(press=lambda **_: {}))
    monkeypatch.setattr(dead_mans_switch, "DeadMansSwitch", Switch)
    monkeypatch.setattr(dead_mans_switch, "stop_on_signals", lambda: SimpleNamespace(requested=True))
    assert main(["estop", "--hold", "--json"]) == 1
    printed = capsys.readouterr()
    assert json.loads(printed.out) == {"stopped": False, "drivers": {}}
    assert printed.err.endswith("\nagilo is armed: hears this switch\n")


def test_what_was_heard_counts_although_the_first_look_took_all_of_the_time(monkeypatch):
    """On a busy machine the first look loads the codec for seconds; drivers that had stopped were said not to have."""
    clock = SimpleNamespace(s=0.0)
    monkeypatch.setattr(stop_button.time, "monotonic", lambda: clock.s)
    monkeypatch.setattr(stop_button.time, "sleep", lambda pause_s: setattr(clock, "s", clock.s + pause_s))
    bus, poll = Bus(agilo=confirms(after=9)), stop_button.DriverStates.poll

    def slow(states):
        heard = poll(states)
        if clock.s < 1.0:
            clock.s += 5.0
            for _ in range(9):  # from the e-stops that were under way
                bus.publish_encoded(STOP)
        return heard

    monkeypatch.setattr(stop_button.DriverStates, "poll", slow)
    assert all_stopped(StopButton(bus).press())
