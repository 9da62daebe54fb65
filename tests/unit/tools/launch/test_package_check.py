"""A package whose parts do not hold together is refused at once, with all faults in one list."""

import dataclasses
import sys
from types import SimpleNamespace

import pytest

from tailor.executive import domains
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.interfaces.domain import Scenario
from tailor.schemas import installed
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import domain_names, spec_of
from tailor.schemas.messages import VelocityCommand
from tailor.tools.commands.run import executive
from tailor.tools.launch.checks import package_check, scenario_check
from tailor.tools.launch.checks.package_check import check_package, faults_of_package
from tailor.tools.launch.checks.part_check import LATER, faults_of_parts
from tailor.tools.main import main

NAN = float("nan")


@pytest.mark.parametrize("name", domain_names())
def test_every_installed_package_holds_together(name):
    assert check_package(name).name == name


MODULE = """
import os.path as places
from math import *
try:
    import fast as body
except ImportError:
    body = None
if places:
    class Robot: ...
first, (second, *others) = 1, (2, 3)
"""
PARTS = {
    "scene = 'tailor_cart.scene': there is no module 'tailor_cart.scene'": {"scene": "tailor_cart.scene"},
    "features = 'tailor_cart.bodies:SPACES': module 'tailor_cart.bodies' has no 'SPACES'": {
        "features": "tailor_cart.bodies:SPACES"
    },
    "body = 'tailor_cart.bodies:Missing': module 'tailor_cart.bodies' has no 'Missing'": {
        "body": "tailor_cart.bodies:Missing"
    },
    "draw = 'tailor_cart.broken:draw': '(' was never closed (broken.py, line 1)": {"draw": "tailor_cart.broken:draw"},
    "": {"body": "simulators.of_others:Body", "sampler": "tailor_cart.bodies:second"},
}


@pytest.mark.parametrize("fault", PARTS)
def test_a_part_that_is_not_where_the_spec_says_is_named_without_importing_it(fault, tmp_path, monkeypatch):
    folder = tmp_path / "tailor_cart"
    folder.mkdir()
    for name, text in {"__init__": "", "bodies": MODULE.replace("from math import *", ""), "broken": "f(1"}.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    spec = dataclasses.replace(spec_of("soccer"), **dict.fromkeys(LATER, ""), package="tailor_cart")
    assert list(faults_of_parts(dataclasses.replace(spec, **PARTS[fault]))) == list(filter(None, [fault]))
    assert "tailor_cart.bodies" not in sys.modules


@pytest.mark.parametrize("name", ["places", "body", "Robot", "first", "second", "others", "sqrt"])
def test_names_that_a_module_binds_somewhere_are_found(name, tmp_path, monkeypatch):
    (tmp_path / "tailor_robot.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    spec = dataclasses.replace(spec_of("soccer"), **dict.fromkeys(LATER, ""), package="tailor_robot")
    assert not list(faults_of_parts(dataclasses.replace(spec, body=f"tailor_robot:{name}")))


def changed(action="goToPose", parameter=None, **fields):
    """The soccer domain with another action."""
    soccer = domains.load("soccer")
    old = soccer.actions[action]
    if parameter:
        fields["parameters"] = (dataclasses.replace(old.parameters[0], **parameter), *old.parameters[1:])
    return dataclasses.replace(soccer, actions={**soccer.actions, action: dataclasses.replace(old, **fields)})


def soccer(**fields):
    return dataclasses.replace(domains.load("soccer"), **fields)


def without(*names):
    """The soccer domain, as an object that lacks some members."""
    domain = domains.load("soccer")
    return SimpleNamespace(
        **{each: getattr(domain, each) for each in dir(domain) if each[0] != "_" and each not in names}
    )


def with_members(**members):
    """The soccer domain with other members."""
    domain = without()
    vars(domain).update(members)
    return domain


FAULTS = {
    "name is 'chess', expected 'soccer' by the spec": lambda: soccer(name="chess"),
    "robot is 'hal', expected 'agilo' by the spec": lambda: soccer(robot="hal"),
    "sensors: there is no topic 'lidar'": lambda: soccer(sensors=("odom", "lidar"), required=("odom",)),
    "command_topic: there is no topic 'wings'": lambda: soccer(command_topic="wings"),
    "the domain publishes wings, the driver expects cmd_vel": lambda: soccer(command_topic="wings"),
    "required: 'currents' is none of sensors": lambda: soccer(required=("currents",)),
    "pddl: ": lambda: soccer(pddl="(define"),
    "executables: no action of the PDDL is 'fly'": lambda: soccer(executables={"fly": "goToPose"}),
    " of the PDDL is missing": lambda: soccer(executables={}),
    "which is none of actions": lambda: soccer(actions={}),
    "has the argument 99, expected one of the": lambda: changed(parameter={"argument": 99}),
    "actions['goToPose']: duration_model is '', expected": lambda: changed(duration_model=""),
    "success_model is 'goToPose/luck'": lambda: changed(success_model="goToPose/luck"),
    "actions['goToPose']: duration_model is 'walk/duration', expected one of an action: ": lambda: changed(
        duration_model="walk/duration"
    ),
    "actions['goToPose']: controller is the class GoToPose, expected an object": lambda: changed(controller=GoToPose),
    "actions['goToPose']: controller is 3, expected a callable": lambda: changed(controller=3),
    "returns a NoneType, expected a Domain": lambda: None,
    "SimpleNamespace lacks axes, ready of Domain": lambda: without("axes", "ready"),
    "required is 'odom', expected a tuple of names": lambda: soccer(required="odom"),
    "subgoal_action is 'fly'": lambda: changed(subgoal_action="fly"),
    "actions['dribbleBall']: parameters is empty": lambda: changed("dribbleBall", parameters=()),
    "actions['goToPose']: parameters is empty": lambda: changed(parameters=()),
    "subgoal_action 'goToPose' begins with the quantity 'x', expected one of this action's first label: v": lambda: (
        changed("approachBall", parameters=domains.load("soccer").actions["approachBall"].parameters[3:])
    ),
    "name is None, expected text": lambda: soccer(name=None),
    "actions is [], expected Actions by name": lambda: soccer(actions=[]),
    "axes is None, expected a tuple of Axes": lambda: soccer(axes=None),
    "belief_names is (1, 2), expected a tuple of names": lambda: soccer(belief_names=(1, 2)),
    "actions['goToPose']: parameters is None, expected a tuple of Parameters": lambda: changed(parameters=None),
    "actions['goToPose']: parameters is (None,), expected a tuple of Parameters": lambda: changed(parameters=(None,)),
    "actions['goToPose']: duration_model is None, expected text": lambda: changed(duration_model=None),
    "actions['goToPose']: time_limit_factor is 'x', expected a number": lambda: changed(time_limit_factor="x"),
    "actions['goToPose']: drives is 3, expected a tuple of text": lambda: changed(drives=3),
    "actions['goToPose']: context is 3, expected an ActionContext": lambda: changed(context=3),
    "actions['goToPose']: parameter 'x': argument is '0', expected a whole number": lambda: changed(
        parameter={"argument": "0"}
    ),
    "actions['goToPose']: parameter 'x': tolerance is 'x', expected a number": lambda: changed(
        parameter={"tolerance": "x"}
    ),
    "axis 'v': lower is None, expected a number": lambda: soccer(
        axes=(dataclasses.replace(domains.load("soccer").axes[0], lower=None),)
    ),
    "outlets is 3, expected a tuple of Outlets": lambda: with_members(outlets=3),
    "anchor takes (belief, scenario), expected (belief, scenario, remembered)": lambda: with_members(
        anchor=lambda belief, scenario: frozenset()
    ),
    "kept takes (), expected (belief)": lambda: with_members(kept=lambda: ()),
    "ready is True, expected a callable": lambda: with_members(ready=True),
    "initial_belief returned None, expected a belief": lambda: with_members(initial_belief=lambda: None),
    "belief_values returned None, expected a tuple of numbers": lambda: with_members(belief_values=lambda belief: None),
    "actions['goToPose']: controller takes (state, belief), expected (state, now_ns, belief, arguments)": lambda: (
        changed(controller=lambda state, belief: None)
    ),
    "actions['goToPose']: arguments takes (), expected (values)": lambda: changed(arguments=lambda: None),
    "arguments returns None for 3 rows of parameters, expected 3 rows": lambda: changed(arguments=lambda values: None),
    "arguments returns an array of shape (8,) for 3 rows": lambda: changed(arguments=lambda values: values[0]),
    "arguments cannot be made: KeyError: 'x' (test_package_check.py, line": lambda: changed(
        arguments=lambda values: {}["x"]
    ),
    "occurs twice": lambda: changed(parameter={"name": domains.load("soccer").actions["goToPose"].parameters[1].name}),
    "parameters 'x' and 'y' are both the quantity 'y' of argument 0, expected one parameter for it": lambda: changed(
        parameter={"quantity": "y"}
    ),
    "ranges from nan to": lambda: changed(parameter={"lower": NAN}),
    "is periodic, but ranges from 1 to the same": lambda: changed(
        parameter={"lower": 1.0, "upper": 1.0, "periodic": True}
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_of_a_domain_is_named(fault):
    found = list(faults_of_package(spec_of("soccer"), FAULTS[fault]()))
    assert any(fault in each for each in found), found
    assert all(each.startswith(("tailor.executive.domains.soccer:make: ", "tailor.simnodes.agilo:")) for each in found)


def test_a_message_that_cannot_be_made_is_a_fault_with_its_line(monkeypatch):
    domain = without()
    domain.message = lambda command, stamp_ns: command[9]
    [found] = faults_of_package(spec_of("soccer"), domain)
    assert "cmd_vel: the domain's message cannot be made: IndexError: tuple index out of range (test_package" in found


def test_a_message_that_lacks_a_number_at_an_end_of_its_range_is_a_fault():
    domain, proper = without(), domains.load("soccer").message
    domain.message = lambda command, at: proper(command, at) if command[0] < 0.8 else VelocityCommand(at, None, "x")
    [found] = faults_of_package(spec_of("soccer"), domain)
    assert found.endswith(" for v, omega, and the driver reads None, 'x'")


def test_faults_come_in_the_order_of_the_package():
    unknown = [f"fly{number}" for number in range(9)]
    found = faults_of_package(spec_of("soccer"), soccer(executables=dict.fromkeys(unknown, "goToPose")))
    assert [each.rsplit("'")[-2] for each in found if "no action of the PDDL" in each] == unknown


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('robot = "agilo"', 'robot = "hal"', "driver.toml: robot is 'hal', expected 'agilo'"),
        ("rate_hz = 50", "rate_hz = 3", "driver.toml: odom comes at 3 Hz, expected at least 4 Hz"),
        ("ball =", "lidar =", "driver.toml: sensors: there is no topic 'lidar'"),
        ("rate_hz = 50", "rate = 50", "driver.toml: sensors.odom: unknown key 'rate', expected one of: rate_hz, frame"),
        ("upper = 0.9", "upper = 0.9\nkeep = 0.1", "driver.toml: v: unknown key 'keep', expected one of: name, unit"),
        ("timeout_s = 0.3", "timeout_s = 0.3\nrate = 3", "driver.toml: cmd_vel: unknown key 'rate', expected one of:"),
        ("ball = ", "cmd_vel = ", "driver.toml: cmd_vel is the topic of a command and of a sensor, expected two"),
        ('unit = "m/s"', 'unit = "km/h"', "driver.toml: v has the unit 'km/h', expected m/s as the domain"),
        ("upper = 0.9", "upper = 0.5", "v ranges from -0.9 to 0.9 m/s"),
        (
            'robot = "agilo"',
            'command_topic = "x"',
            "driver.toml: unknown key 'command_topic', expected it in [command]",
        ),
        ("[sensors]", "[[commands]]\n[sensors]", "there are [command] and [[commands]], expected one of them"),
        ("timeout_s = 0.3", "", "timeout_s is missing, expected a finite number"),
        ('robot = "agilo"', "robot = ", "driver.toml: not the specification of a driver: not TOML: Invalid value"),
    ],
)
def test_each_fault_of_a_driver_file_is_named(tmp_path, monkeypatch, old, new, fault):
    text = package_check.file(spec_of("soccer"), "driver").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "driver.toml"
    path.write_text(text.replace(old, new, 1))
    monkeypatch.setattr("tailor.simnodes.driver_spec.file", lambda *_: path)
    monkeypatch.setattr(package_check, "file", lambda *_: path)
    [found] = faults_of_package(spec_of("soccer"), domains.load("soccer"))
    assert fault in found


@pytest.fixture
def scenarios(tmp_path, monkeypatch):
    """An empty folder of soccer's scenarios, and the faults found in it; `draw` reads `leg_m` alone."""
    folder = tmp_path / "scenarios"
    folder.mkdir()
    monkeypatch.setattr(scenario_check, "part", lambda *_: lambda declared, _: ({"x": declared["leg_m"]}, {}, ()))
    for module in (domains, scenario_check):
        monkeypatch.setattr(module, "file", lambda *_: folder)
    return folder, lambda: list(faults_of_package(spec_of("soccer"), domains.load("soccer")))


@pytest.mark.parametrize(
    ("drawn", "fault"),
    [
        (None, "draw returned None, expected (start, places, events)"),
        (({"x": 1.0}, {}), "draw returned ({'x': 1.0}, {}), expected (start, places, events)"),
        (({"x": 1.0}, {}, ({"x": 2.0},)), "cannot be drawn: KeyError: 'at_s'"),
        (({"x": 1.0}, {}, ({"at_s": NAN, "x": 2.0},)), "event 0.at_s is drawn as nan, expected a finite number"),
        (({"x": 1.0}, {}, 3), "cannot be drawn: TypeError: 'int' object is not iterable"),
        ([{"x": 1.0}, {}, [{"at_s": 1.0, "x": 2.0}]], ""),
    ],
)
def test_each_fault_of_what_is_drawn_is_named(scenarios, monkeypatch, drawn, fault):
    folder, faults = scenarios
    monkeypatch.setattr(scenario_check, "part", lambda *_: lambda declared, rng: drawn)
    (folder / "a.pddl").write_text("(define (problem a) (:domain soccer) (:goal (and)))")
    (folder / "a.toml").write_text("problem = 'a.pddl'")
    assert faults() == ([f"{spec_of('soccer').scenarios}/a.toml: {fault}"] if fault else [])


PROPER = Scenario("a", "(define (problem a) (:domain soccer) (:goal (and)))", {})


@pytest.mark.parametrize(
    ("names", "drawn", "fault"),
    [
        (None, None, "there is no scenario"),
        ("tour", None, "scenarios returned 'tour', expected a list of names"),
        ([1], None, "scenarios returned [1], expected a list of names"),
        (["tour"], None, "load_scenario returned None, expected (Scenario, start)"),
        (["tour"], (PROPER,), "load_scenario returned (Scenario("),
        (["tour"], 1 / 3, "load_scenario returned 0.333"),
        (["tour"], (PROPER, {"x": 1.0}), ""),
    ],
)
def test_each_fault_of_a_generator_is_named(monkeypatch, names, drawn, fault):
    spec = dataclasses.replace(spec_of("soccer"), draw="", generator="ours.scenarios")
    made = SimpleNamespace(scenarios=lambda: names, load_scenario=lambda name, rng: drawn)
    monkeypatch.setattr(domains, "spec_of", lambda name: spec)
    for module in (domains, scenario_check):
        monkeypatch.setattr(module, "part", lambda *_: made)
    found = list(scenario_check.faults_of_scenarios(spec, None))
    assert len(found) == bool(fault)
    assert all(each.startswith(f"ours.scenarios: {fault}") for each in found), found


def test_a_generator_that_raises_or_lacks_a_function_is_named(monkeypatch):
    spec = dataclasses.replace(spec_of("soccer"), draw="", generator="ours.scenarios")
    monkeypatch.setattr(domains, "spec_of", lambda name: spec)
    made = SimpleNamespace()
    for module in (domains, scenario_check):
        monkeypatch.setattr(module, "part", lambda *_: made)
    [found] = scenario_check.faults_of_scenarios(spec, None)
    assert "ours.scenarios: scenarios cannot be listed: AttributeError: " in found
    made.scenarios = lambda: ["tour"]
    [found] = scenario_check.faults_of_scenarios(spec, None)
    assert "ours.scenarios: tour cannot be drawn: AttributeError: " in found


def test_scenarios_that_are_missing_are_named(scenarios):
    folder, faults = scenarios
    assert faults() == [f"{spec_of('soccer').scenarios}: there is no scenario"]
    folder.rmdir()
    assert "no such folder" in faults()[0]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (b"= 3", "not TOML: "),
        (b"\xff", "not UTF-8"),
        (b"", "problem is missing, expected the name of a PDDL file"),
        (b"problem = 3", "problem is 3, expected the name of a PDDL file"),
        (b"problem = 'b.pddl'", "problem is 'b.pddl', expected a file beside it"),
        (b"problem = 'a.pddl'\norder = 'last'", "order is 'last', expected a number"),
        (b"problem = 'a.pddl'\nsettings = 1", "settings is 1, expected a table"),
        (b"problem = 'a.pddl'\nlegs_m = [1, 2]", "cannot be drawn: KeyError: 'leg_m'"),
        (b"problem = 'a.pddl'\nleg_m = nan", "x is drawn as nan, expected a finite number"),
    ],
)
def test_each_fault_of_a_scenario_file_is_named_with_the_file(scenarios, text, fault):
    folder, faults = scenarios
    (folder / "a.pddl").write_text("(define (problem a) (:domain soccer) (:goal (and)))")
    (folder / "good.toml").write_text("problem = 'a.pddl'\norder = 2\nleg_m = 1")
    assert faults() == []
    (folder / "bad.toml").write_bytes(text)
    [found] = faults()
    assert found.startswith(f"{spec_of('soccer').scenarios}/bad.toml: {fault}")


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (b"(define (problem a)", "a.pddl:1:1: this parenthesis is never closed"),
        (b"(define (problem a) (:domain chess) (:goal (and)))", "a.pddl:1:30: the problem belongs to domain 'chess'"),
        (b"(define (problem a) (:domain soccer) (:goal (final pos3)))", "a.pddl:1:52: unknown object 'pos3'"),
        (b"\xff", "a.pddl: not UTF-8"),
    ],
)
def test_each_fault_of_a_problem_is_named_with_both_files(scenarios, text, fault):
    folder, faults = scenarios
    (folder / "a.pddl").write_bytes(text)
    (folder / "bad.toml").write_text("problem = 'a.pddl'\nleg_m = 1")
    [found] = faults()
    assert found.startswith(f"{spec_of('soccer').scenarios}/bad.toml: {fault}")


def test_all_faults_stand_in_one_line(monkeypatch):
    bad = soccer(name="chess", sensors=("lidar",), command_topic="wings")
    monkeypatch.setattr(domains, "load", lambda _: bad)
    with pytest.raises(UsageError) as refused:
        check_package("soccer")
    text = str(refused.value)
    assert text.startswith("the package of soccer does not hold together: ")
    assert text.count("; ") >= 4
    assert "\n" not in text


@pytest.mark.parametrize(("text", "fault"), [(b"= 3", "not TOML: "), (b"\xff", "not UTF-8")])
def test_without_that_check_a_scenario_file_that_is_no_toml_is_named_too(scenarios, text, fault):
    folder, _ = scenarios
    (folder / "bad.toml").write_bytes(text)
    with pytest.raises(UsageError, match=rf"domain soccer: .*/bad\.toml: {fault}"):
        domains.scenarios("soccer")


def test_the_executive_reads_the_scenarios_of_a_checked_package_only(monkeypatch, capsys):
    def refused(_):
        raise UsageError("scenarios/tour.toml: order is 'last', expected a number")

    monkeypatch.setattr(executive, "stop_on_signals", lambda: None)
    monkeypatch.setattr(executive, "check_package", refused)
    monkeypatch.setattr(domains, "scenarios", lambda _: sorted(["last", 2]))
    assert main(["executive", "soccer"]) == 2
    assert "order is 'last'" in capsys.readouterr().err


@pytest.mark.parametrize("method", ["initial_belief", "kept"])
def test_code_that_raises_while_it_is_asked_is_named_in_one_line(method, monkeypatch):
    def breaks(*_):
        raise KeyError("wheel")

    spec, domain = dataclasses.replace(spec_of("soccer"), package="tailor_cart"), without(method)
    setattr(domain, method, breaks)
    monkeypatch.setattr(package_check, "spec_of", lambda name: spec)
    monkeypatch.setattr(domains, "load", lambda name: domain)
    fault = r"^the package of soccer cannot be checked: KeyError: 'wheel' \(test_package_check.py, line \d+\)$"
    with pytest.raises(UsageError, match=fault):
        check_package("soccer")


def test_a_package_that_makes_nothing_is_named(monkeypatch):
    monkeypatch.setattr(installed, "part", lambda *_: lambda: None)
    fault = r"^domain soccer: domain = '.*:make': returned None, expected an object: a `return` is missing$"
    with pytest.raises(UsageError, match=fault):
        domains.load("soccer")
