"""Feature spaces (Table 7): the paper's formulas, their limits, and what they ignore."""

import numpy as np
import pytest

from tailor.models.features.joints import joints
from tailor.models.features.obstacle import one_obstacle
from tailor.models.features.planar import projective, projective_periodic, projective_turn, relative
from tailor.models.features.spaces import feature_space, feature_spaces

PI = np.pi


def norm(a):
    return (a + PI) % (2 * PI) - PI


def poses(count: int, seed: int = 0):
    rng = np.random.default_rng(seed)
    return rng.uniform([-3.5, -2.25, -PI, 0] * 2, [3.5, 2.25, PI, 0.6] * 2, (count, 8))


def test_projective_features_are_those_of_table_7() -> None:
    rows = poses(20000)
    x, y, phi, v, xg, yg, phig, vg = rows.T
    sight = np.arctan2(yg - y, xg - x)
    to = norm(sight - phi)
    at = np.where(to < 0, -1, 1) * norm(phig - sight)
    expected = np.stack([v, vg, np.hypot(xg - x, yg - y), np.abs(to), at], axis=1)
    assert np.abs(projective(rows) - expected).max() < 2e-5


@pytest.mark.parametrize("name", feature_spaces())
def test_every_space_is_finite_and_wide_as_it_declares(name: str) -> None:
    space = feature_space(name)
    rest = np.random.default_rng(1).uniform(-2, 2, (1000, max(0, len(space.arguments) - 8)))
    features = space(np.hstack([poses(1000), rest])[:, : len(space.arguments)])
    assert features.shape == (1000, len(space.features))
    assert features.dtype == np.float32
    assert np.isfinite(features).all()


def test_at_zero_distance_what_is_left_is_the_turn() -> None:
    rows = poses(100)
    rows[:, 4:6] = rows[:, :2]
    _, _, dist, to, at = projective(rows).T
    assert (dist == 0).all()
    assert (to == 0).all()
    assert np.allclose(at, norm(rows[:, 6] - rows[:, 2]), atol=1e-5)


def test_obstacle_is_seen_from_the_way_and_from_both_of_its_ends() -> None:
    rng, rows = np.random.default_rng(2), poses(5000)
    place, radius = rng.uniform([-3.5, -2.25], [3.5, 2.25], (5000, 2)), rng.uniform(0, 0.3, 5000)
    features = one_obstacle(np.column_stack([rows, place, radius]))
    x, y, phi, _, xg, yg, phig, _ = rows.T
    start, goal = np.array([x, y]).T, np.array([xg, yg]).T
    way = (goal - start) / np.hypot(*(goal - start).T)[:, None]
    to = norm(np.arctan2(*way.T[::-1]) - phi)
    off, off_g = place - start, place - goal
    along = (off * way).sum(axis=1)
    across = np.where(to < 0, -1, 1) * (way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0])
    on_way = start + way * np.clip(along, 0, np.hypot(*(goal - start).T))[:, None]
    near = [np.hypot(*(place - at).T) - radius for at in (on_way, start, goal)]
    angles = [np.abs(norm(np.arctan2(o[:, 1], o[:, 0]) - p)) for o, p in ((off, phi), (off_g, phig))]
    assert np.abs(features[:, :5] - projective(rows)).max() == 0
    assert np.abs(features[:, 5:] - np.stack([along, across, *near, *angles], axis=1)).max() < 1e-4


def test_obstacle_mirrored_on_the_way_gives_the_same_features() -> None:
    rows = np.column_stack([poses(500), np.random.default_rng(3).uniform(-2, 2, (500, 3))])
    rows[:, [1, 5]] *= 0.0  # the way lies on the x axis
    mirrored = rows * np.where(np.isin(np.arange(11), (2, 6, 9)), -1.0, 1.0)
    assert np.abs(one_obstacle(mirrored) - one_obstacle(rows)).max() < 1e-5


def test_obstacle_is_seen_from_a_turn_on_the_spot() -> None:
    rows = np.column_stack([poses(100), np.random.default_rng(3).uniform(-2, 2, (100, 3))])
    rows[:, 4:6] = rows[:, :2]
    features = one_obstacle(rows)
    assert np.isfinite(features).all()
    assert np.allclose(features[:, 7], np.hypot(*(rows[:, 8:10] - rows[:, :2]).T) - rows[:, 10], atol=1e-5)


@pytest.mark.parametrize("turn", [-2 * PI, 2 * PI])
def test_a_whole_turn_changes_nothing(turn: float) -> None:
    rows = poses(500)
    turned = rows.copy()
    turned[:, 2] += turn
    turned[:, 6] -= turn
    assert np.allclose(projective(rows), projective(turned), atol=1e-5)


def test_goal_straight_behind_is_half_a_turn_whatever_the_sign_of_zero() -> None:
    rows = np.array([[0, 0, 0, 0, -1, 0.0, 0, 0], [0, 0, 0, 0, -1, -0.0, 0, 0], [0, 0, PI, 0, 1, 0, PI, 0]])
    to = projective(rows)[:, 3]
    assert np.allclose(to, PI, atol=1e-5)


def test_periodic_features_do_not_jump_where_the_angle_at_the_goal_passes_half_a_turn() -> None:
    angles = np.array([PI - 1e-4, -PI + 1e-4, PI / 2, -PI / 2, 0.3])
    rows = np.array([[0, 0, 0, 0, 1, 0, angle, 0] for angle in angles])
    ahead, aside = projective_periodic(rows)[:, 5:].T
    assert np.allclose(ahead, [PI, PI, PI / 2, PI / 2, 0.3], atol=1e-3)
    assert np.allclose(np.abs(aside), [0, 0, PI / 2, PI / 2, 0.3], atol=1e-3)
    assert np.array_equal(projective_periodic(rows)[:, :5], projective(rows))


def test_mirrored_tasks_look_alike() -> None:
    rows = poses(2000)
    mirrored = rows * np.array([1, -1, -1, 1] * 2)
    assert np.allclose(projective(rows), projective(mirrored), atol=1e-5)


def test_features_do_not_depend_on_where_the_field_is_or_how_it_lies() -> None:
    rows = poses(2000)
    angle, shift = 1.1, np.array([0.7, -0.4])
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = rows.copy()
    for k in (0, 4):
        moved[:, k : k + 2] = rows[:, k : k + 2] @ rotation.T + shift
        moved[:, k + 2] += angle
    assert np.allclose(projective_turn(rows), projective_turn(moved), atol=1e-3)
    rows[:, [0, 4]] += 0.5
    assert np.allclose(relative(rows), relative(rows - np.array([0.5, 0, 0, 0] * 2)), atol=1e-6)


def test_joints_at_rest_leave_and_arrive_along_the_line_of_sight() -> None:
    v, v_g, dist, leave, arrive = joints(np.array([[0.1, 0, 0.2, 0, 0.4, 0, 0.6, 0]])).T
    assert np.allclose([v, v_g, dist, leave, arrive], [[0], [0], [0.5], [0], [0]], atol=1e-6)


def test_wrong_number_of_arguments_is_told() -> None:
    with pytest.raises(ValueError, match=r"projective takes \(n, 8\)"):
        projective(np.zeros((3, 7)))
