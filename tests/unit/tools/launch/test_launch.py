"""What the launcher concludes from its children: whose messages count, and what a lost recording means."""

import argparse
from pathlib import Path
from types import SimpleNamespace

import pytest

from tailor.executive.composition import ExecutiveConfig
from tailor.runtime.processes.supervised import State
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ExecStatus, ProcessState, Sample
from tailor.schemas.own import example
from tailor.tools.cli.live_status import processes_text
from tailor.tools.cli.systems.bus_settings import BusSettings
from tailor.tools.cli.systems.deployment import executive_config
from tailor.tools.cli.systems.system_flags import deployment_from
from tailor.tools.commands.run import executive, up
from tailor.tools.launch import system
from tailor.tools.launch.process_reports import ProcessReports
from tailor.tools.launch.processes import (
    LaunchConfig,
    executive_process,
    hardware_process,
    record_process,
    scene_process,
    sim_process,
)
from tailor.tools.launch.recording_watch import ENDED, RecordingWatch
from tailor.tools.launch.senders import Senders
from tailor.tools.main import main

S = 1_000_000_000


def status(sender):
    return Sample("exec/status", example(ExecStatus), 0, 1, sender)


def test_only_the_current_child_counts_and_never_a_stranger_or_its_predecessor():
    senders = Senders()
    assert not senders.sent(status(""), "executive"), "before its first start nobody counts"
    first = senders.arguments("executive", 1)[1]
    assert senders.sent(status(first), "executive")
    assert not senders.sent(status("bb" * 16), "executive")
    assert not senders.sent(status(""), "executive")
    second = senders.arguments("executive", 2)[1]
    assert senders.sent(status(second), "executive")
    assert not senders.sent(status(first), "executive")
    senders.arguments("sim", 1)
    assert not senders.sent(status(second), "sim")


def test_only_the_first_executive_has_the_leave_to_arm():
    senders = Senders()
    assert senders.arguments("executive", 1) == ("--sender", senders.leave)
    assert senders.leave not in senders.arguments("executive", 2)
    assert senders.leave not in senders.arguments("sim", 1)


def config(**changes):
    recorded = {"record": Path("r.mcap")} | changes
    return LaunchConfig(ExecutiveConfig("soccer", "approach"), BusSettings(), **recorded)


@pytest.mark.parametrize("refused", [True, False])
def test_a_robot_whose_process_refuses_its_input_is_bad_input(refused):
    """`tailor up` ended with 1, a negative result, where the extra of the simulator was missing."""
    run = object.__new__(system._System)
    run._config, run._senders, run._robot = config(record=None, scene=False), Senders(), "agilo"
    run._stop = SimpleNamespace(requested=False)
    run._supervisor = SimpleNamespace(
        start=lambda *_: None, state=lambda _: State.ENDED, refused=lambda name: refused and name == "sim"
    )
    if not refused:
        assert run.run() == "failed: the simulator did not start"
        return
    with pytest.raises(UsageError, match="failed: the simulator did not start"):
        run.run()


def test_hardware_that_is_awaited_is_awaited_no_longer_than_there_is_an_executive():
    run = object.__new__(system._System)
    run._config, run._senders, run._robot = config(record=None, hardware="robot.toml"), Senders(), "agilo"
    run._stop = SimpleNamespace(requested=False)
    states, polls = {"driver": State.STARTING, "executive": State.STARTING}, []
    run._supervisor = SimpleNamespace(start=lambda *_: None, state=states.get)

    def poll(_):
        polls.append(1)
        states["executive"] = State.ENDED
        assert len(polls) < 3, "it waits on"

    run._poll = poll
    assert run.run() == "failed: executive ended"


def test_only_the_first_start_of_a_driver_knows_who_has_leave():
    senders = Senders()
    sim = sim_process(config(), senders, "agilo")
    assert sim.command_line(1)[-2:] == ["--leave", senders.leave]
    assert senders.leave not in sim.command_line(2)
    executive = executive_process(config(), senders)
    assert executive.command_line(1)[-2:] == ["--sender", senders.leave]
    assert senders.leave not in executive.command_line(2)


@pytest.mark.promise("P41")
def test_only_the_first_start_of_an_executive_has_a_goal():
    executive = executive_process(config(), Senders())
    assert "--wait" not in executive.command_line(1)
    assert all("--wait" in executive.command_line(start) for start in (2, 3))
    assert executive.restart_note == ", without a goal: arm the robot, then `tailor goal` sends one"


def executive_settings(monkeypatch, *flags):
    """Settings that `tailor up` with these flags has checked, and those that its executive starts with."""
    configs, parser = [], argparse.ArgumentParser()
    monkeypatch.setattr(up, "run_system", lambda config, *_: configs.append(config) or "achieved")
    assert main(["up", "soccer", "--once", *flags]) == 0
    line = executive_process(configs[0], Senders()).command_line(1)
    executive.configure(parser)
    arguments = parser.parse_args(line[line.index("executive") + 1 :])
    return configs[0].executive, executive_config(arguments.domain, deployment_from(arguments))


@pytest.mark.parametrize("table", ["", "after_plans = 5", "limit_s = 3.0", 'engine = "pocl"'])
@pytest.mark.parametrize(
    ("named", "flags"), [("", ()), ("cat", ()), ("cat", ("--planner", "")), ("", ("--planner", "cat"))]
)
def test_an_executive_starts_with_the_settings_that_its_launcher_has_checked(
    tmp_path, monkeypatch, capsys, table, named, flags
):
    """With planner.after_plans it started without the external planner of the file, and nobody was told."""
    file = tmp_path / "d.toml"
    file.write_text(f'[planner]\ncommand = "{named}"\n{table}\n')
    checked, started = executive_settings(monkeypatch, "--config", str(file), "--seed", "3", "--horizon", "1", *flags)
    assert started == checked
    assert started.settings.external.command == (flags[1] if flags else named)


def test_hardware_takes_the_simulators_place_and_gets_no_leave():
    senders = Senders()
    assert (config().driver, config(hardware="robot.toml").driver) == ("sim", "driver")
    hardware = hardware_process(config(hardware="robot.toml"), senders)
    assert hardware.command_line(1)[-1:] == [senders.of("driver")]
    assert "--leave" not in hardware.command_line(1)
    executive = executive_process(config(hardware="robot.toml"), senders).command_line(1)
    assert executive[executive.index("--driver-sender") + 1] == senders.of("driver")


def test_every_child_is_missed_when_it_is_silent():
    senders = Senders()
    specs = (
        executive_process(config(), senders),
        hardware_process(config(hardware="robot.toml"), senders),
        sim_process(config(), senders, "agilo"),
        record_process(config(), senders),
        scene_process(config(), senders),
    )
    assert [(spec.name, spec.silence_ns / S, spec.restarts) for spec in specs] == [
        ("executive", 1.0, True),
        ("driver", 2.0, True),
        ("sim", 2.0, True),
        ("record", 10.0, False),
        ("scene", 10.0, True),
    ]


def test_a_lost_recording_is_reported_once_and_the_run_goes_on():
    lines = []
    watch = RecordingWatch(False, lines.append)
    for ended, lacks in [(False, ""), (False, "disk: full"), (False, "disk: full"), (True, "disk: full"), (True, "")]:
        assert watch.failure(ended, lacks) == ""
    assert lines == ["the recording is incomplete: disk: full", ENDED]


def test_a_required_recording_ends_the_run_when_it_ends_or_lacks_something():
    watch = RecordingWatch(True, lambda line: None)
    assert watch.failure(False, "") == ""
    assert watch.failure(False, "3 messages dropped") == "failed: the recording is incomplete: 3 messages dropped"
    assert watch.failure(True, "") == "failed: the recording ended"


def state(name, **changes):
    fields = {"pid": 7, "state": "running", "starts": 1, "silent_s": 0.0, "status": "", "sender": ""}
    return ProcessState(name, **(fields | changes))


class Published:
    def __init__(self):
        self.messages = []

    def publish(self, message):
        self.messages.append(message)

    show = publish


def test_process_states_are_published_on_change_and_once_a_second():
    senders, published, shown = Senders(), Published(), Published()
    sender = senders.arguments("sim", 1)[1]
    reports = ProcessReports(published, senders, shown)
    for now_ns in range(0, 2 * S, 50_000_000):
        reports.publish((state("sim", silent_s=now_ns / S),), now_ns)
    assert len(published.messages) == 2
    reports.publish((state("sim", starts=2),), 2 * S)
    assert len(published.messages) == 3
    assert published.messages[-1].processes == (state("sim", starts=2, sender=sender),)
    assert shown.messages == published.messages


def test_the_live_status_shows_every_process():
    reports = Published()
    processes = (state("sim"), state("executive", starts=2), state("record", state="ended", status="disk: full"))
    ProcessReports(reports, Senders(), Published()).publish(processes, 0)
    assert processes_text(reports.messages[0]) == "sim running  executive running (2 starts)  record ended: disk: full"
