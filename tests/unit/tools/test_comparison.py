"""Statistics and comparisons of synthetic recordings."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.codec import encode
from tailor.schemas.messages import (
    ActionFinished,
    DriverState,
    ExecStatus,
    InstantiatedAction,
    JointCommand,
    Odometry,
    Parameter,
    RefinementReport,
    Subgoals,
    TickReport,
    VelocityCommand,
)
from tailor.schemas.messages.kitchen import GripperCommand
from tailor.schemas.own import example
from tailor.tools.main import main
from tailor.tools.recordings.comparison import chosen, compared_run
from tailor.tools.recordings.survey import Stream

EXECUTIVE, DRIVER = "ab" * 16, "cd" * 16
MS = 1_000_000
START_NS = 1_700_000_000 * 10**9


class Script:
    """Writes a recording, message by message."""

    def __init__(self, path):
        self.tape, self.numbers, self.path = McapWriter(path, {}), {}, path

    def say(self, at_ms, key, message, sender=EXECUTIVE, skip=0):
        number = self.numbers[key] = self.numbers.get(key, 0) + 1 + skip
        wall_ns = START_NS + at_ms * MS
        raw = Raw(key, encode(message), pack(Origin(number, wall_ns, sender)), encoding_of(type(message)), True, None)
        self.tape.write(raw, wall_ns)

    def close(self):
        self.tape.close()
        return str(self.path)


def a_run(path, speed=0.5, slower_ms=0):
    script = Script(path)
    status, finished = example(ExecStatus), example(ActionFinished)
    for tick in range(1, 21):
        at = tick * 100
        script.say(at, "agilo/odom", Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0), DRIVER, skip=tick == 10)
        script.say(
            at, "agilo/driver", replace(example(DriverState), mode="stopped" if tick > 15 else "armed", reason="r")
        )
        script.say(at, "agilo/cmd_vel", VelocityCommand(0, 0.0 if tick < 3 else speed, 0.1 if tick == 12 else 0.0))
        script.say(at, "exec/tick", replace(example(TickReport), tick=tick, lateness_ns=tick * MS, skipped=tick == 7))
        mode = "FAULT" if tick == 20 else "EXECUTING"
        result = "achieved" if tick >= 19 else ""
        script.say(at, "exec/status", replace(status, tick=tick, mode=mode, reason="no", goal="(g)", result=result))
    action = replace(finished, action="goToPose", outcome="done", predicted_s=4.0, actual_s=5.0 + slower_ms / 1000)
    script.say(2100, "exec/finished", action)
    return script.close()


def a_run_with_three_outlets(path, bend=0.2):
    """A mobile manipulator at rest for two ticks; then its base, arm and gripper move."""
    script = Script(path)
    for tick in range(1, 11):
        moving = tick > 2
        commands = {
            "cmd_vel": VelocityCommand(0, 0.5 if moving else 0.0, 0.0),
            "joint_cmd": JointCommand(0, ("pan", "lift"), (0.0, bend if moving else 0.0)),
            "gripper_cmd": GripperCommand(0, 0.05 if moving else 0.12),
        }
        for number, (topic, command) in enumerate(commands.items()):
            script.say(tick * 100 + number, f"b21/{topic}", command)
        script.say(tick * 100 + 5, "exec/tick", replace(example(TickReport), tick=tick))
    return script.close()


def json_of(capsys, *arguments):
    code = main([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_info_summarises_a_recording(tmp_path, capsys):
    code, info = json_of(capsys, "info", a_run(tmp_path / "a.mcap"))
    assert code == 0
    assert (info["messages"], info["duration_s"], info["damage"], info["drops"]) == (101, 2.0, "", {})
    odom = next(t for t in info["topics"] if t["key"] == "agilo/odom")
    assert odom == {
        "key": "agilo/odom",
        "type": "nav_msgs/msg/Odometry",
        "sender": DRIVER,
        "count": 20,
        "rate_hz": 10.0,
        "longest_gap_s": 0.1,
        "lost": 1,
        "rejected": {},
    }
    assert info["episodes"] == [{"goal": "(g)", "result": "achieved"}]
    done = {"action": "goToPose", "outcome": "done", "predicted_s": 4.0, "actual_s": 5.0, "reason": "", "detail": ""}
    assert info["actions"] == [done]
    assert info["modes"] == {"EXECUTING": 19, "FAULT": 1}
    assert (info["faults"], info["driver_stops"]) == (["no"], ["agilo: r"])
    assert info["ticks"]["late_ms"] == {"p50": 10.5, "p99": 19.81, "max": 20.0}
    assert info["ticks"]["skipped_periods"] == 1


def test_info_counts_one_fault_of_an_executive_beside_another_and_one_stop_of_a_driver(tmp_path, capsys):
    """Each status of the one in FAULT passed for a new fault, as the other one was in another mode between them."""
    script = Script(tmp_path / "a.mcap")
    status, driver = example(ExecStatus), example(DriverState)
    for tick in range(1, 11):
        for sender, mode in ((EXECUTIVE, "FAULT"), (DRIVER, "EXECUTING")):
            script.say(tick * 100, "exec/status", replace(status, tick=tick, mode=mode, reason="no"), sender)
        for sender, mode in ((EXECUTIVE, "stopped"), (DRIVER, "disarmed")):
            script.say(tick * 100, "agilo/driver", replace(driver, mode=mode, reason="r"), sender)
    _, info = json_of(capsys, "info", script.close())
    assert (info["faults"], info["driver_stops"]) == (["no"], ["agilo: r"])


def test_info_states_why_an_action_was_given_up_and_no_error_of_its_model(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    script = Script(tmp_path / "a.mcap")
    ended = replace(example(ActionFinished), action="goToPose", predicted_s=4.0, actual_s=3.0)
    script.say(100, "exec/finished", replace(ended, outcome="aborted", reason="support lost", detail="(holding cup1)"))
    script.say(200, "exec/finished", replace(ended, outcome="done", reason="", detail="early", actual_s=3.99))
    assert main(["info", str(script.close())]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines() if "aborted" in line or "done" in line]
    assert rows[0][1:] == ["aborted", "4.00", "3.00", "support", "lost:", "(holding", "cup1)"]
    assert rows[1][1:] == ["done", "4.00", "3.99", "+0%", "early"]


def test_commands_of_other_axes_are_not_equal(tmp_path, capsys):
    """Axes were compared by their place, those that one run lacks not at all: a base equalled a base with an arm."""
    whole, base = Script(tmp_path / "whole.mcap"), Script(tmp_path / "base.mcap")
    for tick in range(1, 6):
        for script, keys in ((whole, ("agilo/cmd_vel", "rover/cmd_vel")), (base, ("agilo/cmd_vel",))):
            for key in keys:
                script.say(tick * 100, key, VelocityCommand(0, 0.5, 0.1))
            script.say(tick * 100 + 5, "exec/tick", replace(example(TickReport), tick=tick))
    files = whole.close(), base.close()
    code, compared = json_of(capsys, "compare", *files)
    assert (code, compared["equal"], compared["commands"]["first_s"]) == (1, False, None)
    assert [len(compared[side]["axes"]) for side in ("first", "second")] == [4, 2]
    assert main(["compare", *files]) == 1
    assert "axes: v [m/s], omega [rad/s], v [m/s], omega [rad/s] against v" in capsys.readouterr().out


def test_commands_of_two_robots_without_an_axis_in_common_are_not_compared(capsys):
    """Metres a second were compared with radians a second: RMS 0.780, largest 2.395."""
    files = [f"tests/data/golden/{name}.mcap" for name in ("soccer-approach", "arm-word-I")]
    code, compared = json_of(capsys, "compare", *files)
    assert (code, compared["equal"]) == (1, False)
    assert compared["commands"] == {"seconds": 3.9, "first_s": None, "rms": None, "max": None}
    assert main(["compare", *files]) == 1
    *_, axes, commands = capsys.readouterr().out.splitlines()
    assert axes == "axes: v [m/s], omega [rad/s] against pan [rad/s], lift [rad/s]"
    assert commands == "commands: not compared, as no axis is of both runs"


def test_a_run_that_ends_earlier_is_named(tmp_path, capsys):
    """The commands were "equal over" the shorter run, with exit code 1 and no reason."""
    files = []
    for count in (5, 8):
        script = Script(tmp_path / f"{count}.mcap")
        for tick in range(1, count):
            script.say(tick * 100, "agilo/cmd_vel", VelocityCommand(0, 0.5, 0.1))
            script.say(tick * 100 + 5, "exec/tick", replace(example(TickReport), tick=tick))
        files.append(script.close())
    assert main(["compare", *files]) == 1
    assert "number of commands: 4 against 7; compared as far as both go" in capsys.readouterr().out


def test_the_rest_of_a_damaged_run_does_not_pass_for_the_run_in_a_comparison(tmp_path, capsys):
    whole, torn = a_run(tmp_path / "whole.mcap"), tmp_path / "torn.mcap"
    torn.write_bytes(Path(whole).read_bytes()[:-40])
    main(["compare", whole, str(torn), "--json"])
    captured = capsys.readouterr()
    assert captured.err.startswith("torn.mcap is damaged: no footer; ")
    assert captured.err.count("only its readable messages are shown") == 1
    json.loads(captured.out)


def test_a_comparison_tells_that_a_file_holds_further_runs(tmp_path, capsys):
    script = Script(tmp_path / "two.mcap")
    for number, sender in enumerate((EXECUTIVE, "ef" * 16)):
        script.say(number, "exec/tick", replace(example(TickReport), tick=1), sender)
    both, one = script.close(), a_run(tmp_path / "one.mcap")
    main(["compare", both, one, "--json"])
    captured = capsys.readouterr()
    assert captured.err == f"two.mcap holds 2 runs: the first one, of executive {EXECUTIVE[:8]}, is compared\n"
    json.loads(captured.out)


def test_gaps_between_unsigned_messages_are_no_loss():
    """Other recorders number the messages of all senders together."""
    for sender, lost in ((DRIVER, 7), ("", 0)):
        stream = Stream("odom", "nav_msgs/msg/Odometry", sender)
        for at_ns, number in enumerate((1, 9)):
            stream.add(Recorded("odom", "nav_msgs/msg/Odometry", sender, number, at_ns, at_ns, b""))
        assert stream.lost == lost


def test_a_variable_that_actions_share_has_the_name_of_the_first():
    def action(name, *parameters):
        given = (Parameter(n, k, "label", "m", bound, 0.0, 9.0, value) for n, k, bound, value in parameters)
        return InstantiatedAction(name, 1, False, 1.0, 0.0, tuple(given))

    first = action("goToPose", ("x", 1, True, 0.0), ("xg", 2, False, 2.5))
    second = action("dribbleBall", ("x", 2, False, 2.5), ("vg", 3, False, 0.4))
    plan = replace(example(Subgoals), actions=(first, second))
    assert chosen(plan) == {"goToPose.xg": 2.5, "dribbleBall.vg": 0.4}


def results_of(tmp_path, capsys, *rows):
    """Results that `tailor info` lists, of (goal, result, sender, requested goal), one row a tick."""
    script = Script(tmp_path / "results.mcap")
    for tick, (goal, result, sender, requested) in enumerate(rows):
        status = replace(example(ExecStatus), tick=tick, goal=goal, result=result, sender=sender)
        script.say(tick * 100, "exec/status", status, sender)
        script.say(tick * 100, "exec/tick", replace(example(TickReport), tick=tick, goal=requested), sender)
    _, info = json_of(capsys, "info", script.close())
    return [episode["goal"] for episode in info["episodes"]]


OTHER = "ef" * 16


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ([("(g)", "", EXECUTIVE, "(g)"), ("(g)", "achieved", EXECUTIVE, ""), ("(g)", "achieved", EXECUTIVE, "")], 1),
        ([("(g)", "achieved", EXECUTIVE, "(g)"), ("(h)", "achieved", EXECUTIVE, "(h)")], 2),
        ([("(g)", "achieved", EXECUTIVE, "(g)"), ("(g)", "achieved", EXECUTIVE, "")], 1),
        (
            [
                ("(g)", "achieved", EXECUTIVE, ""),
                ("(g)", "achieved", EXECUTIVE, "(g)"),
                ("(g)", "achieved", EXECUTIVE, ""),
            ],
            2,
        ),
        ([("(g)", "achieved", EXECUTIVE, ""), ("(g)", "", EXECUTIVE, "(g)"), ("(g)", "achieved", EXECUTIVE, "")], 2),
        ([("(g)", "failed", EXECUTIVE, ""), ("(g)", "failed", OTHER, ""), ("(g)", "failed", EXECUTIVE, "")], 2),
    ],
)
def test_each_task_is_listed_once_whatever_its_result(tmp_path, capsys, rows, expected):
    assert len(results_of(tmp_path, capsys, *rows)) == expected


@pytest.mark.parametrize("command", ["cut", "replay", "record"])
@pytest.mark.parametrize("words", ["", ","])
def test_topics_that_name_none_are_refused_and_not_taken_for_all(command, words, tmp_path, capsys):
    files = [] if command == "record" else [a_run(tmp_path / "a.mcap")]
    output = ["-o", str(tmp_path / "b.mcap")] if command != "replay" else []
    assert main([command, *files, *output, "--topics", words]) == 2
    assert f"topics {words!r}" in capsys.readouterr().err
    assert not (tmp_path / "b.mcap").exists()


def test_info_in_words_names_the_actions(tmp_path, capsys):
    assert main(["info", a_run(tmp_path / "a.mcap")]) == 0
    output = capsys.readouterr().out
    assert "goToPose done 4.00 5.00 +25%" in " ".join(output.split())
    assert "driver stopped: agilo: r" in output
    assert "ticks, ms: late p50 10.5, p99 19.8, max 20.0; work p50 " in output


def test_info_names_each_topic_in_full_on_a_terminal_of_80_columns(tmp_path, capsys, monkeypatch):
    script = Script(tmp_path / "a.mcap")
    script.say(0, "exec/refinement", example(RefinementReport))
    monkeypatch.setenv("FORCE_COLOR", "1")  # as on a terminal
    monkeypatch.setenv("COLUMNS", "80")
    assert main(["info", script.close()]) == 0
    assert "exec/refinement" in capsys.readouterr().out


def test_info_of_a_damaged_file_reports_it_and_returns_1(tmp_path, capsys):
    path = a_run(tmp_path / "a.mcap")
    (tmp_path / "cut.mcap").write_bytes(Path(path).read_bytes()[:-100])
    code, info = json_of(capsys, "info", str(tmp_path / "cut.mcap"))
    assert code == 1
    assert info["damage"].startswith("no footer")


def test_a_run_compares_equal_to_itself(tmp_path, capsys):
    path = a_run(tmp_path / "a.mcap")
    code, comparison = json_of(capsys, "compare", path, path)
    assert (code, comparison["equal"]) == (0, True)
    assert comparison["commands"] == {"seconds": 1.7, "first_s": None, "rms": 0.0, "max": 0.0}


def test_a_comparison_escapes_the_result_of_a_stranger(tmp_path, capsys):
    """It was printed as it is: one recording could clear the screen, or write lines of its own."""
    script = Script(tmp_path / "a.mcap")
    status = replace(example(ExecStatus), tick=1, mode="IDLE", goal="(g)", result="x\ncommands: equal\x1b[2J")
    script.say(100, "exec/status", status)
    script.say(105, "exec/tick", replace(example(TickReport), tick=1))
    path = script.close()
    assert main(["compare", path, path]) == 0
    assert "results: x\\ncommands: equal\\x1b[2J" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["info", "cut", "recover"])
def test_the_name_of_a_recording_controls_no_terminal(command, tmp_path, capsys):
    path = tmp_path / "a\x1b[2J\u202e.mcap"
    a_run(path)
    if command == "recover":
        path.write_bytes(path.read_bytes()[:-50])
    main([command, str(path)])
    out = capsys.readouterr().out
    assert "a\\x1b[2J\\u202e" in out
    assert "\x1b" not in out


def test_choices_that_differ_by_the_sign_of_zero_are_one(tmp_path, capsys):
    script = Script(tmp_path / "a.mcap")
    for tick, rad in enumerate((0.001, -0.001), start=1):
        aside = Parameter("aside", 1, "spot", "rad", False, -0.3, 0.3, rad)
        grip = InstantiatedAction("grip", 1, False, 1.0, 0.0, (aside,))
        script.say(tick * 100, "exec/tick", replace(example(TickReport), tick=tick))
        script.say(tick * 100, "exec/subgoals", replace(example(Subgoals), actions=(grip,)))
    path = script.close()
    assert main(["compare", path, path]) == 0
    assert capsys.readouterr().out.count("grip.aside") == 2  # once for each of both runs


def test_different_runs_are_distinguished(tmp_path, capsys):
    first, second = a_run(tmp_path / "a.mcap"), a_run(tmp_path / "b.mcap", speed=0.25, slower_ms=500)
    code, comparison = json_of(capsys, "compare", first, second)
    assert (code, comparison["equal"]) == (1, False)
    assert comparison["commands"]["first_s"] == 0.0
    assert comparison["commands"]["max"] == 0.25
    assert (comparison["first"]["total_s"], comparison["second"]["total_s"]) == (5.0, 5.5)
    assert main(["compare", first, second, "--plot", str(tmp_path / "c.png")]) == 1
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")
    assert "durations: 5.00 s against 5.50 s (+10.0%)" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["info", "compare", "cut", "recover", "replay"])
def test_a_file_that_is_no_recording_is_reported_in_one_line_with_exit_code_2(command, tmp_path, capsys):
    path = tmp_path / "no.mcap"
    path.write_text("not at all")
    assert main([command, *[str(path)] * (2 if command == "compare" else 1)]) == 2
    output = capsys.readouterr().err
    assert output == f"tailor {command}: {path}: not an MCAP file\n"


def test_all_outlets_of_a_robot_are_compared_axis_by_axis(tmp_path, capsys):
    one = a_run_with_three_outlets(tmp_path / "one.mcap")
    other = a_run_with_three_outlets(tmp_path / "other.mcap", bend=0.3)
    code, alike = json_of(capsys, "compare", one, one)
    assert code == 0
    assert alike["commands"]["seconds"] == pytest.approx(0.7)  # eight ticks in motion
    code, apart = json_of(capsys, "compare", one, other)
    assert code == 1
    assert apart["commands"]["max"] == pytest.approx(0.1)
    run = compared_run(Path(one))
    assert run.axes == ("v [m/s]", "omega [rad/s]", "width [m]", "pan [rad/s]", "lift [rad/s]")
    assert run.commands[0].tolist() == [0.0, 0.5, 0.0, 0.05, 0.0, 0.2]


@pytest.mark.parametrize("name", ["soccer-approach-dribble", "arm-word-I"])
@pytest.mark.parametrize("back_ms", [80, 1500])
def test_a_clock_that_was_set_back_makes_no_difference(tmp_path, capsys, name, back_ms):
    """Commands were sought by times that came twice, or half a period apart: an equal run seemed to differ."""
    path, back = Path(__file__).parents[2] / "data" / "golden" / f"{name}.mcap", tmp_path / "back.mcap"
    messages = list(open_recording(path).messages())
    writer = McapWriter(back, {})
    for number, m in enumerate(messages):
        earlier_ns = back_ms * MS * (number >= len(messages) // 2)
        writer.copy(m.key, m.declared, (m.log_ns - earlier_ns, m.data, m.publish_ns, m.sequence))
    writer.close()
    code, compared = json_of(capsys, "compare", str(path), str(back))
    assert (code, compared["commands"]["max"]) == (0, 0.0)


def test_outlets_of_one_tick_stay_together_however_late_they_come(tmp_path):
    script = Script(tmp_path / "a.mcap")
    for tick in range(1, 11):
        stamp_ns, late_ms = START_NS + tick * 100 * MS, 70 * (tick == 5)
        script.say(tick * 100, "b21/cmd_vel", VelocityCommand(stamp_ns, 0.1 * tick, 0.0))
        script.say(tick * 100 + late_ms, "b21/gripper_cmd", GripperCommand(stamp_ns, 0.01 * tick))
        script.say(tick * 100 + 90, "exec/tick", replace(example(TickReport), tick=tick))
    commands = compared_run(Path(script.close())).commands
    assert commands[:, 1] == pytest.approx(10 * commands[:, 3])
