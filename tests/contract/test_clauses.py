"""Each clause of the contract can fail: for each there is a robot that breaks it, and no other one."""

import dataclasses
import math
import random
import shutil
import types
from itertools import chain

import numpy as np
import pytest

from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.values import Interval
from tailor.models.features.features import FeatureSpace, quantities
from tailor.schemas.installed import models_folder
from tailor.schemas.packages.scene import sphere
from tailor.tools.contract import package_clauses
from tailor.tools.contract.subject import Subject
from tailor.tools.contract.suite import CLAUSES, cases, ordered_clauses
from tailor.tools.contract.units import is_unit
from tailor.tools.new_robot.templates import kinds
from tests.support.robots.known_robot import known_robot


@pytest.fixture(scope="module")
def cart(tmp_path_factory):
    with known_robot("cart", "wheeled", tmp_path_factory.mktemp("robots")):
        yield


@pytest.fixture
def subject(cart):
    made = Subject("cart", runs=1)
    made.scenarios = made.scenarios[:1]
    yield made
    shutil.rmtree(models_folder("cart"), ignore_errors=True)  # of the robot with bad models


def broken(subject):
    """Names of the clauses that a package breaks."""
    return {clause.name for clause, case in cases(subject) if list(clause.check(subject, case))}


@pytest.mark.parametrize("kind", kinds())
def test_a_new_robot_keeps_every_clause(kind, tmp_path):
    with known_robot("trolley", kind, tmp_path):
        subject = Subject("trolley", runs=2)
        assert broken(subject) == set()
        assert {clause.name for clause, _ in cases(subject)} == set(CLAUSES)


def test_clauses_come_in_one_order_whichever_of_their_modules_was_imported_first(monkeypatch):
    last_module_first = dict(sorted(CLAUSES.items(), key=lambda item: item[1].check.__module__, reverse=True))
    before = ordered_clauses()
    monkeypatch.setattr("tailor.tools.contract.suite.CLAUSES", last_module_first)
    assert ordered_clauses() == before
    assert before[0].name == "holds_together"


@pytest.mark.parametrize("missing", ["body", "sampler"])
def test_clauses_about_a_part_that_the_package_lacks_are_left_out(missing, subject):
    subject.spec = dataclasses.replace(subject.spec, **{missing: ""})
    left = {clause.name for clause, _ in cases(subject)}
    assert {clause.name for clause in CLAUSES.values() if not clause.needs} <= left
    assert not any(CLAUSES[name].needs in (missing, "body") for name in left)


def with_action(subject, **changes):
    domain = subject.domain
    domain.actions = {"drive": dataclasses.replace(domain.actions["drive"], **changes)}


def with_controller(subject, change):
    plain = subject.domain.actions["drive"].controller

    def controller(state, now_ns, belief, arguments):
        return change(plain(state, now_ns, belief, arguments), now_ns)

    with_action(subject, controller=controller)


def with_readings(subject, change):
    plain = subject.body.advance
    subject.body.advance = lambda ns: list(chain.from_iterable(map(change, plain(ns))))


def with_scenario(subject, change):
    plain = subject.scenario
    subject.scenario = lambda name, seed: change(*plain(name, seed))


BAD = {}


def breaks(robot):
    BAD[robot.__name__] = robot
    return robot


@breaks
def holds_together(subject):
    with_action(subject, duration_model="drive/luck")


@breaks
def axes_contain_rest(subject):
    v, omega = subject.domain.axes
    subject.domain.axes = (dataclasses.replace(v, unit=""), omega)


@breaks
def parameters_have_units(subject):
    first, *others = subject.domain.actions["drive"].parameters
    with_action(subject, parameters=(dataclasses.replace(first, unit=""), *others))


@breaks
def command_becomes_a_message(subject):
    plain = subject.domain.message
    subject.domain.message = lambda command, stamp_ns: plain(command, 0)


@breaks
def not_ready_before_a_percept(subject):
    subject.domain.ready = lambda belief: True


@breaks
def belief_values_have_units(subject):
    subject.domain.belief_names = ("x", "y (m)", "phi (rad)", "v (m/s)", "omega (rad/s)")


@breaks
def models_fit_the_actions(subject):
    folder = models_folder("cart") / "cart" / "drive"
    folder.mkdir(parents=True)
    (folder / "duration.card.json").write_text("{}")


SPACES = (FeatureSpace("sine", quantities("a:m"), quantities("a:m"), lambda rows, ops: np.sin(rows)),)


@breaks
def features_can_be_exported(subject):
    subject.spec = dataclasses.replace(subject.spec, features=f"{__name__}:SPACES")


@breaks
def samples_are_finite_and_vary(subject):
    always = subject.sample("drive", 1)
    subject.sample = lambda action, seed: always


@breaks
def samples_follow_the_seed(subject):
    plain = subject.sample
    subject.sample = lambda action, seed: plain(action, random.getrandbits(32))


@breaks
def batches_are_rows(subject):
    with_action(subject, arguments=lambda values: values - values.mean(axis=0))


@breaks
def runs_follow_the_seed(subject):
    def wobble(control, now_ns):
        v, omega = control.command
        return dataclasses.replace(control, command=(v * random.uniform(0.95, 1.0), omega))

    with_controller(subject, wobble)


@breaks
def commands_are_within_the_axes(subject):
    with_controller(subject, lambda c, now_ns: c if now_ns else dataclasses.replace(c, command=(5.0, 0.0)))


@breaks
def goals_are_reached(subject):
    with_controller(subject, lambda c, now_ns: c if now_ns < 1e9 else dataclasses.replace(c, outcome="failed"))


@breaks
def scenarios_follow_the_seed(subject):
    with_scenario(subject, lambda drawn, start: (drawn, {**start, "x": start["x"] + random.random()}))


@breaks
def scenarios_are_finite(subject):
    def lost(drawn, start):
        return dataclasses.replace(drawn, places={**drawn.places, "nowhere": {"x": math.nan}}), start

    with_scenario(subject, lost)


@breaks
def belief_becomes_ready(subject):
    subject.domain.ready = lambda belief: False


@breaks
def belief_values_are_finite(subject):
    subject.domain.belief_values = lambda belief: (0.0, 0.0, math.inf, 0.0, 0.0)


@breaks
def scenarios_can_be_planned(subject):
    def unreachable(drawn, start):
        return dataclasses.replace(drawn, problem=drawn.problem.replace("(visited s1)", "(visited home)")), start

    with_scenario(subject, unreachable)


@breaks
def plans_can_be_instantiated(subject):
    def value(query):
        raise Conflict("unknown")

    subject.domain.value = value


@breaks
def something_is_free(subject):
    subject.domain.value = lambda query: Interval(0.0, 0.0)


@breaks
def body_names_its_robot(subject):
    subject.body.robot = "hal"


@breaks
def sensors_keep_their_rates(subject):
    with_readings(subject, lambda reading: [reading] * (2 if reading.topic == "odom" else 1))


@breaks
def readings_are_in_order(subject):
    def late(reading):
        early = reading.time_ns - 50_000_000 * (reading.topic == "planar_truth")
        return [dataclasses.replace(reading, time_ns=early)]

    with_readings(subject, late)


@breaks
def body_follows_the_seed(subject):
    def noisy(reading):
        if reading.topic == "planar_truth":
            return [dataclasses.replace(reading, message=dataclasses.replace(reading.message, x=random.random()))]
        return [reading]

    with_readings(subject, noisy)


@breaks
def repeated_set_points_change_nothing(subject):
    plain = subject.body.command

    def nudging(values):
        plain(values)
        subject.body._robot.qpos[0] += 1e-4

    subject.body.command = nudging


def with_scene(subject, **changes):
    plain = subject.scene
    functions = {name: getattr(plain, name) for name in ("of_belief", "of_truth", "of_subgoal")}
    subject.scene = types.SimpleNamespace(**functions | changes)


@breaks
def scene_can_be_drawn(subject):
    plain = subject.scene.of_belief
    lost = sphere("lost", 0.1, frame="nowhere")
    with_scene(subject, of_belief=lambda values: dataclasses.replace(plain(values), shapes=(lost,)))


@breaks
def belief_is_drawn_where_the_truth_is(subject):
    plain = subject.scene.of_belief
    with_scene(subject, of_belief=lambda values: plain({**values, "x": values["x"] + 2.0}))


@breaks
def subgoals_have_places(subject):
    with_scene(subject, of_subgoal=lambda values: None)


@pytest.mark.parametrize(
    ("failing", "success_model", "kept"), [(1, "", False), (1, "drive/success", True), (2, "drive/success", False)]
)
def test_an_action_with_a_model_of_success_may_fail_in_some_runs(failing, success_model, kept, subject):
    subject.runs, plain = 2, subject.run
    with_action(subject, success_model=success_model)
    subject.run = lambda case, seed: dataclasses.replace(plain(case, seed), done=seed >= failing)
    assert (list(CLAUSES["goals_are_reached"].check(subject, "drive")) == []) is kept


def subgoal_faults(subject):
    return list(CLAUSES["subgoals_have_places"].check(subject, ""))


def test_a_subgoal_without_a_quantity_in_metres_need_not_be_drawn(subject):
    """At run time, too, it is left out of scenes: the grip of a gripper has no place."""
    parameters = subject.domain.actions["drive"].parameters
    with_action(subject, parameters=tuple(dataclasses.replace(each, unit="rad") for each in parameters))
    with_scene(subject, of_subgoal=lambda values: None)
    assert subgoal_faults(subject) == []


def test_an_action_without_parameters_has_no_subgoal_to_draw(subject):
    with_action(subject, parameters=())
    assert subgoal_faults(subject) == []


def test_a_subgoal_with_a_quantity_in_metres_must_be_drawn(subject):
    with_scene(subject, of_subgoal=lambda values: None)
    assert subgoal_faults(subject) == [
        "drive: of_subgoal returns None for x, y, phi, v, expected a pose: x, y are in metres, which mark a place"
    ]


@pytest.mark.parametrize("unit", ["metres", "mps", "M", "Kg", "m/", "-", "rads", "sec", "RPM", "m s-", "0", 3])
def test_free_text_is_no_unit(unit, subject):
    expected = f"has the unit {unit!r}, expected SI symbols such as m, rad/s"
    v, omega = subject.domain.axes
    subject.domain.axes = (dataclasses.replace(v, unit=unit), omega)
    subject.domain.belief_names = (f"x ({unit})", "y (m)", "phi (rad)", "v (m/s)", "omega (rad/s)")
    first, *others = subject.domain.actions["drive"].parameters
    column = ContextColumn("box_x", unit, -1.0, 1.0)
    context = ActionContext((column,), lambda belief: [], "drive/clearance", "box")
    with_action(subject, parameters=(dataclasses.replace(first, unit=unit), *others), context=context)
    names = ("axes_contain_rest", "parameters_have_units", "belief_values_have_units")
    found = {name: "; ".join(CLAUSES[name].check(subject, "")) for name in names}
    assert f"axis v {expected}" in found["axes_contain_rest"]
    assert f"drive: parameter x {expected}" in found["parameters_have_units"]
    assert f"drive: column box_x {expected}" in found["parameters_have_units"]
    assert f"'x ({unit})' has the unit '{unit}', expected SI" in found["belief_values_have_units"]


UNITS = ("m", "rad", "1", "m/s", "rad/s", "m/s²", "m/s^2", "m/s2", "N·m", "Nm", "kg", "cm", "deg", "%", "1/s", "s⁻¹")


@pytest.mark.parametrize("unit", UNITS)
def test_symbols_of_si_and_compounds_are_units(unit):
    assert is_unit(unit)


OF_SEVERAL_OUTLETS = ("outlets_are_driven",)  # test_outlet_clauses.py


@pytest.mark.parametrize("name", [name for name in sorted(CLAUSES) if name not in OF_SEVERAL_OUTLETS])
def test_a_robot_that_breaks_a_clause_breaks_it_alone(name, subject):
    BAD[name](subject)
    assert broken(subject) == {name}


def test_a_model_of_success_beside_an_object_is_not_forgotten(subject, monkeypatch):
    """Without it, the executive of a robot that keeps to the contract does not start."""
    names = [{"name": parameter.name} for parameter in subject.domain.actions["drive"].parameters]
    duration = types.SimpleNamespace(card={"arguments": names})
    models = types.SimpleNamespace(durations={"drive/duration": duration}, successes={})
    monkeypatch.setattr(package_clauses, "load_models", lambda robot: models)
    (models_folder("cart") / "cart").mkdir(parents=True)
    check = CLAUSES["models_fit_the_actions"].check
    assert list(check(subject, "")) == []
    column = ContextColumn("box_x", "m", -1.0, 1.0)
    with_action(subject, context=ActionContext((column,), lambda belief: [], "drive/clearance", "box"))
    assert list(check(subject, "")) == ["drive: there is no model drive/clearance"]
