"""Figures 1, 11 and 15: what is measured on the runs that they draw."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.schemas.errors import UsageError
from tailor.schemas.messages import ActionFinished
from tailor.tools.evaluations.assertion import figure15
from tailor.tools.evaluations.assertion.subgoal_map import subgoal_map_of
from tailor.tools.evaluations.assertion.subgoal_map_plot import draw_subgoal_map
from tailor.tools.evaluations.costs import NO_COSTS
from tailor.tools.evaluations.outcome import Task, Variant
from tailor.tools.evaluations.refinement import figure11
from tailor.tools.evaluations.refinement.figure1 import dribble_s, handover_mps, path_m, slow_s, until_ball_s
from tailor.tools.evaluations.refinement.sweep import sweep_of
from tailor.tools.evaluations.refinement.sweep_plot import draw_sweep, figure_of
from tailor.tools.evaluations.traced_runs import trace_run
from tailor.tools.figures.track import Track, TrackPoint
from tests.unit.tools.evaluations.test_refinement_evaluations import DONE

TRAINING_SEED = 700_000  # evaluation seeds begin at a million
FORESEEN = (("goToPose", True, 2.0), ("approachBall", False, 3.0), ("dribbleBall", False, 4.0))


def point(time_s, v, name):
    return TrackPoint(time_s, 0.0, 0.0, 0.0, v, {}, 0, name)


def test_time_spent_hardly_moving_and_the_speed_at_the_ball_are_read_off_the_track():
    speeds = [("approachBall", 0.5), ("approachBall", 0.05), ("dribbleBall", -0.02), ("dribbleBall", 0.3)]
    track = Track("run", [point(0.1 * k, v, name) for k, (name, v) in enumerate(speeds)])
    assert slow_s(track) == pytest.approx(0.2)
    assert handover_mps(track) == pytest.approx(0.02)
    assert math.isnan(handover_mps(Track("run", track.points[:2])))


def test_path_and_durations_are_read_off_the_track():
    track = Track("run", [replace(point(0.1 * k, 0.5, "a"), x=0.3 * k, y=0.4 * k) for k in range(3)])
    names = ("approachBall", "dribbleBall", "approachBall", "dribbleBall")
    track.finished += [ActionFinished(0, 0, name, k, "done", "", 0.0, k + 1.0) for k, name in enumerate(names)]
    assert path_m(track) == pytest.approx(1.0)
    assert (until_ball_s(track), dribble_s(track)) == (6.0, 4.0)
    assert path_m(Track("empty")) == 0.0


def test_sweep_splits_an_episode_where_the_approach_has_succeeded():
    twice = ("approachBall", "approachBall", "dribbleBall")
    tried_again = replace(
        DONE, actions=twice, outcomes=("failed", "done", "done"), actual_s=(2.0, 3.0, 4.0), duration_s=9.5
    )
    sweep = sweep_of(1, np.array([0.0, 1.0]), 0.2, [[tried_again], [DONE]], 0.0, 0.0)
    assert sweep.simulated_s[:, 0].tolist() == [5.0, 4.5, 9.5]
    assert sweep.simulated_s[:, 1].tolist() == [4.0, 6.0, 10.0]


def test_sweep_predicts_subgoals_as_part_of_the_approach():
    sweep = sweep_of(1, np.array([0.0]), 0.2, [[replace(DONE, predicted_actions=FORESEEN)]], 0.0, 0.0)
    assert sweep.predicted_s[:, 0].tolist() == [5.0, 4.0, 9.0]
    assert sweep.asserted.tolist() == [True]


def test_sweep_leaves_failed_runs_out_and_needs_one_that_is_not():
    failed = replace(DONE, achieved=False, predicted_actions=FORESEEN)
    done = replace(DONE, predicted_actions=FORESEEN)
    sweep = sweep_of(1, np.array([0.0, 1.0]), 0.2, [[failed, done], [failed, failed]], 0.0, 0.0)
    assert sweep.simulated_s[2, 0] == 10.0
    assert np.isnan(sweep.simulated_s[:, 1]).all()
    assert sweep.model_best == 0
    assert sweep_of(1, np.array([0.0]), 0.2, [[failed]], 0.0, 0.0) is None


def test_sweep_leaves_out_a_run_that_reached_its_goal_without_an_approach():
    aborted = replace(DONE, outcomes=("aborted", "done"), predicted_actions=FORESEEN)
    done = replace(DONE, predicted_actions=FORESEEN)
    sweep = sweep_of(1, np.array([0.0, 1.0]), 0.2, [[aborted], [done]], 0.0, 0.0)
    assert np.isnan(sweep.simulated_s[:, 0]).all()


def test_a_figure_without_any_sweep_is_a_usage_error(monkeypatch):
    monkeypatch.setattr(figure11, "_swept", lambda *_: None)
    given = argparse.Namespace(zoo="", seed=1, episodes=2)
    with pytest.raises(UsageError, match="--episodes 2: no start had a free angle"):
        figure11.run(given)


def test_the_last_row_of_figure_11_says_of_how_many_starts_it_is_the_mean():
    foreseen = [(*FORESEEN[:2], ("dribbleBall", False, s)) for s in (4.0, 5.0, 6.0)]
    runs = [[replace(DONE, duration_s=8.0 + k, predicted_actions=each)] for k, each in enumerate(foreseen)]
    angles, failed = np.array([-1.0, 0.0, 1.0]), [replace(DONE, achieved=False)]
    whole, part = (sweep_of(1, angles, 0.2, made, 0.0, 0.0) for made in (runs, [*runs[:2], failed]))
    rows = [figure11._row(sweep) for sweep in (whole, part)]
    assert [row["angles"] for row in rows] == [3, 2]
    mean = figure11._mean(rows)
    assert (mean["start"], mean["angles"]) == ("mean of 2", 2.5)
    assert set(mean) <= set(rows[0]), "a column means the same in each row"


def test_duration_between_two_angles_wraps_round_the_circle():
    angles = np.linspace(-math.pi, math.pi, 4, endpoint=False)
    runs = [[replace(DONE, duration_s=s, predicted_actions=FORESEEN)] for s in (8.0, 20.0, 20.0, 10.0)]
    sweep = sweep_of(1, angles, 0.2, runs, 0.0, 0.0)
    assert sweep.simulated_at(0.75 * math.pi) == pytest.approx(9.0)


def test_an_angle_that_is_forced_is_the_one_that_is_taken(tmp_path):
    watched, _ = trace_run(Task("soccer", "approach-dribble"), figure11._pinned(1.0, 0.2, 0), TRAINING_SEED)
    told = {(label, quantity): value for label, quantity, value in watched.outcome.bound}
    assert (told["pos2", "phi"], told["pos2", "v"]) == (1.0, 0.2)
    assert [name for name, *_ in watched.outcome.predicted_actions][-2:] == ["approachBall", "dribbleBall"]
    sweep = sweep_of(1, np.array([-1.0, 1.0]), 0.2, [[watched.outcome]] * 2, 0.0, 0.0)
    draw_sweep(sweep, [watched.track] * 3, tmp_path / "sweep.png")
    assert (tmp_path / "sweep.png").stat().st_size > 10_000
    figure = figure_of(sweep, [watched.track] * 3)
    figure.draw_without_rendering()
    legends = [axis.get_legend().get_window_extent() for axis in figure.subfigs[1].axes]
    sides = [0.0, *(side for legend in legends for side in (legend.x0, legend.x1)), figure.bbox.x1]
    assert sides == sorted(sides), "legends lie over one another, or beyond the picture"


def test_other_noise_is_another_run_from_the_same_start():
    task, plain = Task("soccer", "approach-dribble"), Variant("h2")
    first, again, other = (trace_run(task, v, TRAINING_SEED)[0] for v in (plain, plain, replace(plain, noise=500_000)))
    assert first.outcome == again.outcome
    assert first.track.points != other.track.points
    assert (first.track.points[0].x, first.track.points[0].objects["ball"][0]) == pytest.approx(
        (other.track.points[0].x, other.track.points[0].objects["ball"][0]), abs=0.05
    )


@pytest.fixture(scope="module")
def asserted():
    """The first approach with one subgoal before it."""
    for seed in range(TRAINING_SEED, TRAINING_SEED + 10):
        watched, context = trace_run(Task("soccer", figure15.SCENARIO), figure15.COMPARED[1], seed)
        ground = subgoal_map_of(watched.subgoals[0], context, watched.first_contexts) if watched.subgoals else None
        if ground is not None:
            return watched, ground
    raise AssertionError("no subgoal was asserted in 10 approaches")


def test_ground_is_valid_exactly_where_the_approach_is_predicted_to_succeed(asserted):
    _, ground = asserted
    assert np.array_equal(np.isfinite(ground.total_s), ground.success >= 1 - ground.limit)
    assert 0 < ground.valid_pct < 100
    assert ground.least_s <= sum(ground.chosen_s)


def test_the_chosen_subgoal_costs_what_was_predicted_for_it(asserted):
    watched, ground = asserted
    assert sum(ground.chosen_s) == pytest.approx(sum(s for *_, s in watched.outcome.predicted_actions[:2]), abs=0.02)
    assert ground.start == pytest.approx((watched.track.points[0].x, watched.track.points[0].y), abs=0.25)


def test_ground_is_drawn(asserted, tmp_path):
    watched, ground = asserted
    draw_subgoal_map(ground, [watched.track] * 2, "start", tmp_path / "ground.png")
    assert (tmp_path / "ground.png").stat().st_size > 10_000


def test_figure_15_counts_the_starts_at_which_a_subgoal_was_asserted():
    approach = replace(DONE, duration_s=4.0)
    with_subgoal = replace(
        approach, asserted=True, predicted_actions=(("goToPose", True, 2.0), ("approachBall", False, 1.5))
    )
    touched = replace(approach, costs=replace(NO_COSTS, contacts=1))
    found = {figure15.BEFORE: {1: touched}, figure15.AFTER: {1: with_subgoal}}
    row = figure15._summary(found, [1])
    assert (row["n"], row["success_before_pct"], row["success_after_pct"]) == (1, 0.0, 100.0)
    assert (row["predicted_s"], row["took_s"], row["bias_s"]) == (3.5, 4.0, -0.5)
