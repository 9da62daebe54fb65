"""`tailor units` writes unit files that systemd accepts, and whose commands our own parsers accept."""

import argparse
import getpass
import importlib
import inspect
import shlex
import shutil
import subprocess
import sys

import pytest

from tailor.models.runtime import ZOO
from tailor.runtime import realtime
from tailor.runtime.processes import restart
from tailor.schemas.errors import UsageError
from tailor.tools.commands.setup import units
from tailor.tools.launch.hosting import GATEWAY_SILENCE_NS
from tailor.tools.launch.processes import EXECUTIVE_SILENCE_NS, RECORDER_SILENCE_NS, SIM_SILENCE_NS
from tailor.tools.launch.units.unit_text import command_line
from tailor.tools.main import COMMANDS, main
from tests.support.injection.small_disk import small_disk

SERVICES = {"bus": "bus", "driver": "sim", "executive": "executive", "recorder": "record"}  # part -> command


def written(tmp_path, *flags):
    """Settings of each file: {name without ending: [(setting, value)]}."""
    folder = tmp_path / "units"
    assert main(["units", str(folder), "--user", "robot", *map(str, flags)]) == 0
    return {file.stem: settings(file.read_text()) for file in folder.iterdir()}


def settings(text):
    return [tuple(line.split("=", 1)) for line in text.splitlines() if "=" in line and not line.startswith("#")]


def command_of(rows):
    """ExecStart as the program receives it."""
    (line,) = [value for key, value in rows if key == "ExecStart"]
    return [word.replace("%%", "%").replace("$$", "$") for word in shlex.split(line)]


@pytest.fixture
def all_units(tmp_path):
    config = tmp_path / "my robot $1 100%.toml"
    config.write_text('[bus]\nendpoint = "tcp/127.0.0.1:7499"\n[executive]\nseed = 3\n')
    return written(tmp_path, "--config", config, "--record", tmp_path, "--scenario", "waypoints")


def test_there_is_a_unit_for_every_part_and_a_target(all_units):
    assert set(all_units) == {"tailor", *(f"tailor-{part}" for part in SERVICES)}
    assert [value for key, value in all_units["tailor"] if key == "Wants"] == [
        f"tailor-{part}.service" for part in ("bus", "recorder", "driver", "executive")
    ]


def test_a_user_whom_systemd_would_not_find_is_refused_and_on_another_machine_reported(tmp_path, capsys, monkeypatch):
    words = ["units", str(tmp_path / "system"), "--user", "no-such-robot"]
    assert main(words) == 0
    reported = capsys.readouterr()
    assert (
        reported.err
        == "--user no-such-robot: no such user on this machine; expected on the one that runs these services\n"
    )
    monkeypatch.setattr(units, "SYSTEMD", (str(tmp_path),))
    assert main([*words, "--force"]) == 2
    refused = capsys.readouterr()
    assert "--user no-such-robot: no such user on this machine, expected one that exists" in refused.err
    assert refused.out == ""


@pytest.mark.parametrize(
    ("words", "missing"),
    [
        (["--secure", "tls/0.0.0.0:7448", "--keys", "keys"], "keys/router"),
        (["--parts", "driver", "--connect", "tls/robot:7448", "--key", "mine"], "mine"),
    ],
)
def test_a_key_without_which_a_service_ends_is_refused_and_on_another_machine_reported(
    tmp_path, capsys, monkeypatch, words, missing
):
    """The units were written without a word, and the bus ended at each start."""
    monkeypatch.chdir(tmp_path)
    command = ["units", str(tmp_path / "system"), "--user", getpass.getuser(), *words]
    assert main(command) == 0
    reported = capsys.readouterr().err
    assert reported.startswith(f"{tmp_path / missing}: no authority.pem, expected a folder that")
    assert reported.endswith("; expected on the machine that runs these services\n")
    monkeypatch.setattr(units, "SYSTEMD", (str(tmp_path),))
    assert main([*command, "--force"]) == 2
    assert f"{tmp_path / missing}: no authority.pem" in capsys.readouterr().err
    assert main(["keys", "new", "router", "--host", "robot", "--keys", "keys"]) == 0
    assert main(["keys", "new", "mine", "--role", "driver", "--keys", "keys"]) == 0
    (tmp_path / "mine").symlink_to(tmp_path / "keys" / "mine")
    capsys.readouterr()
    assert main([*command, "--force"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("part", SERVICES)
def test_each_command_parses_with_the_commands_own_parser(all_units, part):
    interpreter, isolated, flag, module, name, *arguments = command_of(all_units[f"tailor-{part}"])
    assert (interpreter, isolated, flag, module, name) == (
        sys.executable,
        "-P",
        "-m",
        "tailor.tools.main",
        SERVICES[part],
    )
    parser = argparse.ArgumentParser(exit_on_error=False, allow_abbrev=False)
    importlib.import_module(COMMANDS[name][0]).configure(parser)
    parsed = vars(parser.parse_args(arguments))
    assert parsed["config"].endswith("/my robot $1 100%.toml")
    assert parsed["connect"] == "tcp/127.0.0.1:7499"
    assert not parsed.get("leave"), "after a restart people arm"
    assert parsed.get("scenario", "waypoints") == "waypoints"


def test_the_executive_waits_for_a_goal(all_units):
    assert "--wait" in command_of(all_units["tailor-executive"])


@pytest.mark.parametrize("part", SERVICES)
def test_a_service_that_shall_report_does_report(all_units, part):
    """Without the report, systemd would kill it after the time for its start."""
    module = importlib.import_module(COMMANDS[SERVICES[part]][0])
    assert (dict(all_units[f"tailor-{part}"])["Type"] == "notify") == ("Notifier" in inspect.getsource(module))


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        ("executive", {"WatchdogSec": EXECUTIVE_SILENCE_NS / 1e9, "LimitRTPRIO": realtime.PRIORITY}),
        ("driver", {"WatchdogSec": SIM_SILENCE_NS / 1e9, "LimitRTPRIO": realtime.DRIVER_PRIORITY}),
        ("recorder", {"WatchdogSec": RECORDER_SILENCE_NS / 1e9}),
        ("bus", {"WatchdogSec": GATEWAY_SILENCE_NS / 1e9, "LimitRTPRIO": realtime.BUS_PRIORITY}),
    ],
)
def test_supervision_is_that_of_the_launcher(all_units, part, expected):
    unit = dict(all_units[f"tailor-{part}"])
    assert {key: float(unit[key]) for key in expected} == expected
    assert unit["Restart"] == "on-failure"
    assert unit["RestartPreventExitStatus"] == "2"
    assert float(unit["RestartSec"]) == restart.FIRST_DELAY_NS / 1e9
    assert int(unit["StartLimitBurst"]) == restart.MAX_STARTS
    assert int(unit["StartLimitIntervalSec"]) == restart.WINDOW_NS / 1e9
    assert (unit["KillMode"], unit["TimeoutStopSec"]) == ("mixed", "5")
    assert (unit["NoNewPrivileges"], unit["ProtectSystem"], unit["User"]) == ("yes", "strict", "robot")
    assert "CPUSchedulingPolicy" not in unit, "the program itself asks for it"


def test_services_stop_in_the_reverse_order_and_start_anew_with_the_bus(all_units):
    after = {name: [value for key, value in rows if key == "After"] for name, rows in all_units.items()}
    assert after["tailor-executive"] == ["tailor-bus.service", "tailor-recorder.service", "tailor-driver.service"]
    assert after["tailor-driver"] == ["tailor-bus.service", "tailor-recorder.service"]
    required = {name: dict(rows).get("Requires") for name, rows in all_units.items()}
    assert required == {
        "tailor": None, "tailor-bus": None, "tailor-recorder": "tailor-bus.service",
        "tailor-driver": "tailor-bus.service", "tailor-executive": "tailor-bus.service",
    }  # fmt: skip


def test_only_the_recorder_writes_and_only_into_its_folder(all_units, tmp_path):
    writable = {name: dict(rows).get("ReadWritePaths") for name, rows in all_units.items()}
    assert {name: path for name, path in writable.items() if path} == {"tailor-recorder": str(tmp_path)}


def test_a_bus_of_several_machines_may_use_the_network_and_need_not_run_here(tmp_path):
    made = written(tmp_path, "--connect", "tls/robot.example:7447", "--parts", "executive")
    assert set(made) == {"tailor", "tailor-executive"}
    executive = dict(made["tailor-executive"])
    assert "IPAddressDeny" not in executive
    assert "Requires" not in executive
    assert command_of(made["tailor-executive"])[-2:] == ["--connect", "tls/robot.example:7447"]


def test_a_bus_for_other_machines_takes_its_keys_wherever_it_starts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = written(tmp_path, "--secure", "tls/0.0.0.0:7448", "--keys", "keys")
    bus = command_of(made["tailor-bus"])
    assert bus[bus.index("--secure") + 1] == "tls/0.0.0.0:7448"
    assert bus[bus.index("--keys") + 1] == str(tmp_path / "keys")
    assert "IPAddressDeny" not in dict(made["tailor-bus"])
    assert dict(made["tailor-executive"])["IPAddressDeny"] == "any", "it connects on this machine"


def test_a_part_on_another_machine_has_its_own_key(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = written(tmp_path, "--connect", "tls/robot:7448", "--parts", "executive", "--key", "agilo-executive")
    executive = command_of(made["tailor-executive"])
    assert executive[executive.index("--key") + 1] == str(tmp_path / "agilo-executive")


def test_models_of_the_deployment_file_are_found_wherever_the_service_starts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ZOO, tmp_path / "zoo")
    (tmp_path / "d.toml").write_text('zoo = "zoo"')
    executive = command_of(written(tmp_path, "--config", "d.toml")["tailor-executive"])
    assert executive[executive.index("--zoo") + 1] == str(tmp_path / "zoo")


def test_a_bus_on_this_machine_alone_reaches_no_other(all_units):
    for part in SERVICES:
        assert dict(all_units[f"tailor-{part}"])["IPAddressDeny"] == "any"


def test_a_hardware_driver_replaces_the_simulator(tmp_path):
    made = written(tmp_path, "--driver-command", "/bin/sh -c 'drive $HOME; sleep 1'")
    driver = dict(made["tailor-driver"])
    assert command_of(made["tailor-driver"]) == ["/bin/sh", "-c", "drive $HOME; sleep 1"]
    assert driver["Type"] == "exec", "it may report nothing"
    assert not {"WatchdogSec", "PrivateDevices", "IPAddressDeny"} & set(driver)


def test_existing_files_are_kept_unless_forced(tmp_path):
    (tmp_path / "tailor-driver.service").write_text("mine")
    with pytest.raises(UsageError, match=r"has tailor-driver\.service already"):
        units.run(parsed(str(tmp_path), "--user", "robot"))
    assert [file.name for file in tmp_path.iterdir()] == ["tailor-driver.service"], "nothing is written"
    assert units.run(parsed(str(tmp_path), "--user", "robot", "--force")) == 0
    assert (tmp_path / "tailor-driver.service").read_text() != "mine"


def test_a_full_disk_takes_no_unit_that_was_there(tmp_path, capsys):
    """Half of the new one stood in its place, which systemd starts at the next boot."""
    assert main(["units", str(tmp_path), "--user", "robot"]) == 0
    before = {file: file.read_text() for file in tmp_path.iterdir()}
    capsys.readouterr()
    with small_disk(500):
        assert main(["units", str(tmp_path), "--user", "robot", "--force"]) == 2
    line = capsys.readouterr().err.splitlines()[-1]
    assert line == f"tailor units: {tmp_path}/tailor-bus.service: File too large, expected a file that can be written"
    assert {file: file.read_text() for file in tmp_path.iterdir()} == before


def parsed(*arguments):
    parser = argparse.ArgumentParser()
    units.configure(parser)
    return parser.parse_args(arguments)


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        (("--user", "a b"), "--user a b: expected a user name"),
        (("--user", "robot", "--domain", "chess"), "no domain 'chess'"),
        (("--user", "robot", "--scenario", "x"), "no scenario 'x' in soccer"),
        (("--user", "robot", "--parts", "bus,wheel"), "--parts bus,wheel: unknown wheel, expected some of: bus, "),
        (("--user", "robot", "--parts", "recorder"), "expected --record DIR as well"),
        (("--user", "robot", "--driver-command", "drive"), "--driver-command drive: expected the absolute path"),
        (
            ("--user", "robot", "--driver-command", "/no/drive -v"),
            "--driver-command /no/drive: there is no such program",
        ),
        (("--user", "robot", "--driver-command", "'x"), "--driver-command 'x: No closing quotation"),
        (("--user", "robot", "--connect", "tcp"), "bus endpoint 'tcp': expected PROTOCOL/HOST:PORT"),
        (("--user", "robot", "--connect", "tls/host:7447"), "tls/host:7447: who connects there has a password"),
        (("--user", "robot", "--keys", "k"), "--keys k: expected with --secure"),
        (("--user", "robot", "--key", "k"), "--key k: a key has one role, expected one part that connects"),
        (("--user", "robot", "--record", "nowhere"), "--record 'nowhere': expected a folder that exists"),
        (("--user", "robot", "--driver-command", "/bin/sh 'a\nb'"), "expected text that a unit file can hold"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(tmp_path, flags, expected):
    with pytest.raises(UsageError) as refusal:
        units.run(parsed(str(tmp_path / "new"), *flags))
    assert expected in str(refusal.value)
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    "argument", ["plain", "a b", "", "q\"uo'te", "back\\slash", "100%", "$HOME ${X}", ";", "Größe"]
)
def test_an_argument_arrives_as_it_is(argument):
    assert command_of([("ExecStart", command_line(["/bin/echo", argument]))]) == ["/bin/echo", argument]


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not installed")
@pytest.mark.parametrize("flags", [(), ("--driver-command", "/bin/sh -c 'sleep 1'"), ("--connect", "tcp/host:7447")])
def test_systemd_accepts_the_files(tmp_path, flags):
    record = tmp_path / "100% of my $HOME"
    record.mkdir()
    written(tmp_path, "--record", record, *flags)
    files = sorted(map(str, (tmp_path / "units").iterdir()))
    done = subprocess.run(["systemd-analyze", "verify", *files], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "")
