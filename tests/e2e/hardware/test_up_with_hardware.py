"""`tailor up --hardware` puts a real robot in the simulator's place; it moves only once a person has armed it."""

import json

import pytest

from tailor.executive import domains
from tailor.runtime.bus.opening import open_client
from tailor.tools.main import main
from tests.e2e.hardware.test_plain_robot import killable_bus, moving
from tests.support.bus_system import accepts, answers, free_endpoint
from tests.support.patience import wait_until
from tests.support.robots.driving import achieved, arm, newest, ready

START = [domains.seeded_scenario("soccer", "waypoints", 0)[1][name] for name in ("x", "y", "phi")]


@pytest.mark.slow
@pytest.mark.xdist_group("live")
def test_a_real_robot_drives_to_the_goal_once_a_person_has_armed_it(tmp_path):
    file, trace, ours = tmp_path / "robot.toml", tmp_path / "trace", free_endpoint()
    with killable_bus() as (_, robots, start, _):
        start(
            "tests.support.stand_ins.plain_robot", json.dumps({"endpoint": robots, "trace": str(trace), "start": START})
        )
        file.write_text(f'robot = "agilo"\ncommand = "twist"\n[bus]\nconnect = "{robots}"\n[pose]\nstart = {START}\n')
        flags = ("--scenario", "waypoints", "--hardware", file, "--once", "--no-scene", "--connect", ours)
        system = start("tailor.tools.main", "up", "soccer", *flags)
        wait_until(lambda: accepts(ours) and answers(ours), "bus")
        with open_client(ours, role="people") as people:
            ready(people, "agilo")
            wait_until(people.inbox(["status"], "agilo").drain, "executive")
            states = people.inbox(["driver"], "agilo")
            assert wait_until(lambda: newest(states)).mode == "disarmed"
            assert not moving(trace)()
            arm(people, "agilo")
            assert achieved(system)


def test_another_robot_than_the_domains_is_refused_before_anything_starts(tmp_path, capsys):
    file = tmp_path / "robot.toml"
    file.write_text('robot = "courier"\n')
    assert main(["up", "soccer", "--hardware", str(file), "--connect", free_endpoint()]) == 2
    assert f"--hardware {file}: is of the robot 'courier', expected 'agilo'" in capsys.readouterr().err
