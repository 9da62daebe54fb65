"""The arm's domain: letters become plans through waypoints, and beliefs say where the next reach begins."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tailor.executive import domains, planning
from tailor.executive.domains.arm import belief as believing
from tailor.executive.domains.arm import letters
from tailor.executive.domains.arm import load as loads
from tailor.executive.domains.arm.action_library import LIFT_RAD, PAN_RAD, PASSING_RADPS, fastest_radps
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain_results import measurement_fault
from tailor.executive.refinement.instantiation import instantiate
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import JointState, Sample
from tailor.simnodes.driver_spec import shipped_driver_spec
from tailor.simnodes.powercube.physical_parameters import PhysicalParameters

ARM = domains.load("arm")
ALPHABET = [chr(code) for code in range(ord("A"), ord("Z") + 1)]


def load(name, seed=0):
    return domains.load_scenario("arm", name, np.random.default_rng(seed))


def planned(scenario, text=None):
    pddl = planning.parse_domain(ARM.pddl)
    problem = planning.parse_problem(text or scenario.problem, pddl)
    return planning.Search(pddl, problem).advance(CheckBudget(1000)).plan


def heard(now_ns, a, b, wa=0.0, wb=0.0, names=("pan", "lift", "elbow")):
    state = JointState(now_ns, names, (a, b, 0.3)[: len(names)], (wa, wb, 0.0)[: len(names)], (0.0,) * len(names))
    return Sample("powercube/joint_states", state, now_ns, 1)


def test_every_letter_has_four_to_six_waypoints():
    assert sorted(letters.font()) == ALPHABET
    assert {len(stroke) for stroke in letters.font().values()} == {4, 5, 6}


@pytest.mark.parametrize("letter", ALPHABET)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_every_letter_lies_where_reaches_were_learned(letter, seed):
    scenario, start = load(f"letter-{letter}", seed)
    points = [(place["a"], place["b"]) for place in scenario.places.values()] + [(start["a"], start["b"])]
    assert (np.abs(points).max(axis=0) < (PAN_RAD, LIFT_RAD)).all()


@given(st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZ", min_size=1, max_size=letters.MAX_LETTERS), st.integers(0, 50))
def test_every_word_lies_where_reaches_were_learned(word, seed):
    scenario, _ = load(f"word-{word}", seed)
    assert max(abs(place["a"]) for place in scenario.places.values()) < PAN_RAD
    assert max(abs(place["b"]) for place in scenario.places.values()) < LIFT_RAD
    assert sum(count for _, count in scenario.settings["letters"]) == len(scenario.places)


@pytest.mark.parametrize(
    "name", ["letter-a", "word-", "word-tailor", "word-" + "A" * 13, "letter-AB", "stops-", "ring-", "square"]
)
def test_an_unknown_scenario_is_refused_with_the_known_ones(name):
    with pytest.raises(UsageError, match="letter-A to letter-Z"):
        load(name)


@pytest.mark.parametrize("name", ["letter-T", "word-TAILOR"])
def test_a_plan_goes_through_the_waypoints_in_order(name):
    scenario, _ = load(name)
    goals = [step.action[2] for step in planned(scenario).steps]
    assert goals == list(scenario.places)


def test_a_ring_goes_on_at_its_first_waypoint_and_rests_nowhere():
    scenario, _ = load("ring-HI")
    *_, before, last = scenario.places
    text = scenario.problem.replace("(at home)", f"(at {before})").replace(f"(drawn {last})", "(at p2)")
    assert [step.action[2] for step in planned(scenario, text).steps] == [last, "p1", "p2"]
    assert list(scenario.places) == list(load("word-HI")[0].places)
    assert not any("wa" in place for place in scenario.places.values())


def test_velocities_are_free_at_every_waypoint_but_the_last():
    scenario, start = load("letter-Z")
    belief = ArmBelief(0, (start["a"], start["b"]), (0.0, 0.0), 0)
    sequence = instantiate(planned(scenario), ARM, belief, scenario)
    free = {(v.label, v.quantity) for v in sequence.variables if v.value is None}
    assert free == {(f"p{k}", quantity) for k in (1, 2, 3) for quantity in ("wa", "wb")}
    bound = {(v.label, v.quantity): v.value for v in sequence.variables if v.value is not None}
    assert bound["p4", "wa"] == bound["p4", "wb"] == 0.0
    assert bound["home", "a"] == pytest.approx(start["a"])


def test_a_waypoint_with_a_near_neighbour_is_passed_more_slowly():
    scenario, start = load("word-HI")
    belief = ArmBelief(0, (start["a"], start["b"]), (0.0, 0.0), 0)
    sequence = instantiate(planned(scenario), ARM, belief, scenario)
    free = [variable for variable in sequence.variables if variable.value is None]
    assert all(v.upper == -v.lower == scenario.places[v.label]["fastest"] for v in free)
    points = np.array([(place["a"], place["b"]) for place in scenario.places.values()])
    nearest = np.linalg.norm(np.diff(points, axis=0), axis=1).min()
    assert min(v.upper for v in free) == pytest.approx(fastest_radps(nearest))
    assert fastest_radps(nearest) < fastest_radps(3.0) == PASSING_RADPS


def test_a_hand_that_stops_has_the_same_letters_and_nothing_free():
    (free, start), (stops, same_start) = load("word-ZO", 5), load("stops-ZO", 5)
    assert start == same_start
    assert [(p["a"], p["b"]) for p in free.places.values()] == [(p["a"], p["b"]) for p in stops.places.values()]
    assert all(place["wa"] == place["wb"] == 0.0 for place in stops.places.values())


def test_the_same_seed_writes_the_same_and_another_one_does_not():
    assert load("letter-S", 3) == load("letter-S", 3)
    assert load("letter-S", 3)[0].places != load("letter-S", 4)[0].places


def test_belief_reads_its_joints_by_name_and_predicts_them_to_now():
    belief = believing.update(ArmBelief(), 20_000_000, (heard(10_000_000, 0.5, -0.2, wa=0.3),), (0.0, 0.0))
    assert belief.angles == pytest.approx((0.503, -0.2))
    assert ARM.ready(belief)


def test_a_joint_state_without_our_joints_is_ignored():
    sample = heard(10, 0.5, -0.2, names=("elbow", "wrist"))
    assert not ARM.ready(believing.update(ArmBelief(), 20, (sample,), (0.0, 0.0)))


def test_without_encoders_the_belief_stands_still():
    belief = believing.update(ArmBelief(), 1, (heard(1, 0.5, 0.0, wa=1.0),), (0.0, 0.0))
    later = believing.update(belief, 2_000_000_000, (), (0.0, 0.0))
    assert later.angles == belief.angles


def test_encoder_noise_is_filtered_and_does_not_lag():
    rng, belief = np.random.default_rng(4), ArmBelief(0, (0.0, 0.0), (0.0, 0.0), 0)
    q, v, errors, raw = np.zeros(2), np.zeros(2), [], []
    for tick in range(1, 200):
        command = np.array([0.6 * np.sin(0.15 * tick), -0.4 * np.cos(0.1 * tick) * min(1.0, 0.1 * tick)])
        q, v = q + 0.05 * (v + command), command
        angles, speeds = q + 0.0007 * rng.standard_normal(2), v + 0.02 * rng.standard_normal(2)
        now_ns = tick * 100_000_000
        belief = believing.update(belief, now_ns, (heard(now_ns, *angles, *speeds),), tuple(command.tolist()))
        errors.append(np.subtract(belief.velocities, v))
        raw.append(speeds - v)
    assert np.std(errors) < 0.6 * np.std(raw)
    assert abs(np.mean(errors)) < 0.002
    assert np.abs(np.subtract(belief.angles, q)).max() < 0.003


def test_an_arm_that_does_not_follow_is_believed_where_its_encoders_have_it():
    belief = ArmBelief(0, (0.0, 0.0), (0.0, 0.0), 0)
    belief = believing.update(belief, 100_000_000, (heard(100_000_000, 0.0, 0.0),), (0.8, 0.0))  # braked
    assert belief.angles == belief.velocities == (0.0, 0.0)


def test_friction_is_learned_from_efforts_while_the_joints_move():
    gravity_nm = np.array([0.0, loads.GRAVITY_NM * np.cos(loads.GRAVITY_AT_RAD)])
    dry_nm = loads.COULOMB_NM + loads.LOAD_FRICTION * gravity_nm
    efforts = tuple((gravity_nm + 1.3 * (dry_nm + loads.VISCOUS_NMS * 0.5)).tolist())
    belief = ArmBelief(0, (0.0, 0.0), (0.5, 0.5), 0, (0.5, 0.5))
    for tick in range(1, 12):
        belief = sensed(replace(belief, angles=(0.0, 0.0)), tick, 0.5, efforts)
    assert belief.friction == pytest.approx((1.3, 1.3), abs=0.02)
    assert sensed(belief, 30, 0.0, (0.0, 90.0)).friction == belief.friction


def sensed(belief, tick, speed, efforts):
    now_ns = tick * 100_000_000
    state = JointState(now_ns, ("pan", "lift"), (0.0, 0.0), (speed, speed), efforts)
    return believing.update(belief, now_ns, (Sample("joint_states", state, now_ns, 1),), (speed, speed))


def test_the_next_action_begins_where_the_last_command_leads():
    belief = ArmBelief(0, (0.0, 0.0), (0.0, 0.0), 0)
    belief = believing.update(belief, 100_000_000, (heard(100_000_000, 0.005, 0.0, wa=0.1),), (0.1, 0.0))
    angles, velocities = believing.ahead(belief)
    assert angles == pytest.approx((0.005 + 0.1 * 0.15, 0.0))
    assert velocities == pytest.approx((0.2, 0.0))


def test_the_executives_limits_are_the_drivers():
    declared = shipped_driver_spec("powercube")
    assert declared.command_topic == ARM.command_topic
    assert declared.axes == tuple(axis.name for axis in ARM.axes)
    assert [(limit.lower, limit.upper) for limit in declared.limits] == [(axis.lower, axis.upper) for axis in ARM.axes]
    assert PhysicalParameters().velocity_max_radps == ARM.axes[0].upper


def test_models_get_the_friction_that_is_believed_at_every_waypoint():
    scenario, start = load("letter-L")
    belief = ArmBelief(0, (start["a"], start["b"]), (0.0, 0.0), 0, friction=(1.25, 9.0))
    sequence = instantiate(planned(scenario), ARM, belief, scenario)
    assert len(sequence.actions) > 1
    for reach in sequence.actions:
        friction = [sequence.variables[identifier].value for identifier in reach.variables[8:]]
        assert friction == [1.25, loads.TRAINED_FRICTION[1]]  # within what the models were trained on


@pytest.mark.parametrize(
    ("a", "b", "fault"),
    [
        (2.0, -2.0, ""),
        (2.6, 0.0, ""),  # pushed past its end: it comes back
        (2 * np.pi - 2.0, 0.0, "has pan at 4.28 rad, beyond its end"),
        (0.3 - 2 * np.pi, 0.0, "has pan at -5.98 rad, beyond its end"),
        (0.0, 1e5, "has lift at 1e+05 rad, beyond its end"),
    ],
)
def test_an_encoder_that_reads_beyond_the_end_of_its_joint_is_not_believed(a, b, fault):
    """A turn too much had the arm drive back by a turn, which its end stopped."""
    assert measurement_fault(ARM, ARM.initial_belief(), heard(1, a, b).message) == fault
