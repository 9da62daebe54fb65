"""Bounds of models hold: features, trees and whole models say nothing outside of what was proven for a box."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.models.bounds.bag_bounds import bag_lower_bound
from tailor.models.bounds.leaf_bounds import LeafBounds, Side
from tailor.models.bounds.tree_boxes import tree_boxes
from tailor.models.cards.card import card_path
from tailor.models.features.feature_intervals import FEATURE_SPANS
from tailor.models.features.intervals import Span
from tailor.models.features.spaces import feature_space
from tailor.models.runtime import ZOO
from tests.support.random_trees import Trees

WIDTHS = {"x": 7, "y": 5, "phi": 8, "v": 0.75}
SHAPE = (1, 1, 1)
SHIPPED = sorted(path for kind in ("duration", "success", "energy") for path in ZOO.glob(f"*/*/{kind}.onnx"))
LEARNERS = {path: json.loads(card_path(path).read_text())["learner"] for path in SHIPPED}
LEARNED = [path for path, it in LEARNERS.items() if "network" not in " ".join((it["name"], *it.get("weights", {})))]
spaces = st.sampled_from(
    [
        "direct",
        "relative",
        "projective",
        "projective-turn",
        "projective-periodic",
        "straight-drive",
        "joints",
        "joints-lifted",
        "joints-relative",
        "joints-friction",
        "joints-relative-friction",
        "joints-lifted-friction",
        "one-obstacle",
        "spot",
        "spot-out",
        "spot-handle",
    ]
)
seeds = st.integers(0, 2**32 - 1)


def box(space: str, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A box of arguments: each wide, narrow or a point; often with the same place at both ends, or at rest."""
    scale = np.array([WIDTHS.get(q.name.rstrip("g"), 2.0) for q in feature_space(space).arguments])
    lower = rng.uniform(-0.5, 0.5, len(scale)) * scale
    of_spot = space.startswith("spot")
    if not of_spot and not space.startswith("joints"):
        lower[[3, 7]] = rng.uniform(0, 0.5, 2)
    if rng.random() < 0.2:
        there, here = (slice(3, 5), slice(0, 2)) if of_spot else (slice(4, 8), slice(0, 4))
        lower[there] = lower[here]
    if rng.random() < 0.2:
        lower[[1, 3]] = 0.0
    if len(lower) > 9 and rng.random() < 0.4:
        lower[8:10] = lower[0:2] if rng.random() < 0.5 else lower[4:6]  # an obstacle at the start, or at the goal
    return lower, lower + scale * rng.choice([0.0, 1e-4, 0.03, 0.5], len(scale))


def drawn(lower: np.ndarray, upper: np.ndarray, rng: np.random.Generator, count: int) -> np.ndarray:
    """Points of a box, corners and edges among them."""
    share = rng.choice([0.0, 0.5, 1.0, np.nan], (count, len(lower)))
    share = np.where(np.isnan(share), rng.random(share.shape), share)
    return lower + share * (upper - lower)


def check_features(space: str, lower: np.ndarray, upper: np.ndarray, rng: np.random.Generator) -> None:
    """The features of each of 200 points of a box lie in one of its cases."""
    spans = tuple(Span(np.full(SHAPE, a), np.full(SHAPE, b)) for a, b in zip(lower, upper, strict=True))
    seen = feature_space(space)(drawn(lower, upper, rng, 200))
    met = np.zeros(len(seen), bool)
    for case in FEATURE_SPANS[space](spans):
        if case.possible is None or case.possible.all():
            ends = [(np.float32(s.lower.item()), np.float32(s.upper.item())) for s in case.features]
            met |= np.all([(x >= a) & (x <= b) for x, (a, b) in zip(seen.T, ends, strict=True)], axis=0)
    assert met.all()


@settings(max_examples=300, deadline=None)
@given(spaces, seeds)
def test_features_of_every_argument_in_a_box_lie_in_one_of_its_cases(space, seed):
    rng = np.random.default_rng(seed)
    check_features(space, *box(space, rng), rng)


@settings(max_examples=300, deadline=None)
@given(seeds)
def test_so_do_those_of_drives_to_goals_behind_to_which_a_robot_perhaps_backs_off(seed):
    rng = np.random.default_rng(seed)
    phi, distance_m = rng.uniform(-3.0, 3.0), rng.uniform(0.8, 2.2)
    bearing = phi + np.pi + rng.normal(0.0, 0.8)
    heading = bearing + np.pi + rng.normal(0.0, 0.8)
    goal = distance_m * np.cos(bearing), distance_m * np.sin(bearing)
    middle = np.array([0.0, 0.0, phi, 0.0, *goal, heading, 0.0, float(rng.integers(2))])
    widths = np.array([0.3, 0.3, 0.6, 0.3, 0.3, 0.3, 0.6, 0.3, 0.0]) * rng.choice([0.0, 1e-4, 0.05, 1.0], 9)
    check_features("straight-drive", middle - widths / 2, middle + widths / 2, rng)


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(
        [
            *["relative", "projective", "projective-turn", "projective-periodic", "joints", "joints-lifted-friction"],
            *["one-obstacle", "spot-handle", "straight-drive"],
        ]
    ),
    seeds,
    st.integers(1, 4),
)
def test_model_says_nothing_outside_its_bounds(space, seed, trees):
    rng = np.random.default_rng(seed)
    model = Trees.random(seed, space, trees)
    lower, upper = box(space, rng)
    mean, std = model.predict(drawn(lower, upper, rng, 200))
    ends = tuple(tuple(np.full(SHAPE, value) for value in side) for side in (lower, upper))
    k_std = float(rng.choice([0.0, 0.5, 1.0, 3.0]))
    assert model.bounds.lower_bound(*ends, k_std).item() <= (mean + k_std * std).min()
    assert model.bounds.upper_bound(*ends).item() >= mean.max()


@settings(max_examples=60, deadline=None)
@given(seeds)
def test_bounds_of_a_point_are_nearly_what_the_model_says(seed):
    rng = np.random.default_rng(seed)
    model = Trees.random(seed, trees=4)
    at, _ = box("projective", rng)
    at[4:6] = at[:2] + np.array([1.0, 0.3])
    columns = tuple(np.full(SHAPE, value) for value in at)
    mean, _ = model.predict(at[None])
    near = drawn(at - 1e-5, at + 1e-5, rng, 400)
    alike = np.ptp(model.predict(near)[0]) < 1e-3  # no threshold so near that rounding could tell
    assert not alike or model.bounds.lower_bound(columns, columns).item() == pytest.approx(mean[0], abs=1e-3)


def test_several_boxes_are_bounded_as_each_alone():
    rng = np.random.default_rng(3)
    model = Trees.random(3, trees=3)
    before, own = rng.uniform(-1, 1, (2, 4, 4)), rng.uniform(-1, 1, (2, 5, 4))
    before[1], own[1] = before[0] + 0.2, own[0] + 0.2
    ends = [
        (*(before[k][None, :, None, j] for j in range(4)), *(own[k][None, None, :, j] for j in range(4)))
        for k in range(2)
    ]
    together = model.bounds.lower_bound(ends[0], ends[1], 1.0)
    assert together.shape == (1, 4, 5)
    for i in range(4):
        for j in range(5):
            one = [
                (*(before[k][i, c].reshape(SHAPE) for c in range(4)), *(own[k][j, c].reshape(SHAPE) for c in range(4)))
                for k in range(2)
            ]
            assert model.bounds.lower_bound(one[0], one[1], 1.0).item() == pytest.approx(together[0, i, j], abs=1e-5)


@pytest.mark.parametrize("path", LEARNED, ids=lambda path: "/".join(path.parts[-3:]))
def test_trees_read_from_a_learned_model_say_what_it_says(path):
    card = json.loads(card_path(path).read_text())
    space, golden = feature_space(card["features"]), card["golden"]
    boxes = tree_boxes(path.read_bytes(), len(space.features))
    assert boxes is not None
    said, spread = Trees(space.name, boxes).predict(np.array(golden["arguments"]))
    np.testing.assert_allclose(said, golden[card["outputs"][0]], atol=1e-4)
    if len(card["outputs"]) == 2:
        np.testing.assert_allclose(spread, golden[card["outputs"][1]], atol=1e-4)


@pytest.mark.parametrize("content", [b"", b"\x08\x07", b"no model at all", bytes(range(256))])
def test_what_is_no_model_of_trees_is_not_read(content):
    assert tree_boxes(content, 5) is None


def test_leaves_of_all_trees_meet_every_box():
    bounds = LeafBounds(Trees.random(5, trees=4).boxes)
    everywhere = tuple(Span(np.full(SHAPE, -10.0), np.full(SHAPE, 10.0)) for _ in range(5))
    assert bounds.least(bounds.overlap(everywhere), Side.LEAST).shape == (1, 4, *SHAPE)


@settings(max_examples=300, deadline=None)
@given(seeds, st.integers(2, 12), st.sampled_from([0.3, 1.0, 3.0]))
def test_bag_between_two_values_says_no_less_than_its_bound_which_is_tight_where_k_is_small(seed, trees, k_std):
    rng = np.random.default_rng(seed)
    least = rng.normal(5.0, rng.choice([1e-7, 0.3, 2.0]), (trees, 1)).astype(np.float32)
    most = least + rng.exponential(rng.choice([0.0, 0.1, 3.0]), (trees, 1)).astype(np.float32)
    said = least + rng.choice([0.0, 1.0, np.nan], (trees, 4000), p=[0.6, 0.1, 0.3]) * (most - least)
    said = np.where(np.isnan(said), least + rng.random(said.shape) * (most - least), said)
    levels = np.clip(np.linspace(least.min(), most.max(), 2000), least, most)  # the optimum is of this kind
    cost = np.concatenate([one.mean(axis=0) + k_std * one.std(axis=0) for one in (said, levels)])
    bound = bag_lower_bound(least, most, k_std).item()
    assert bound <= cost.min() + 1e-5
    assert bound > cost.min() - 0.1 or k_std >= 1


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(["relative", "projective", "projective-turn", "projective-periodic", "joints"]), seeds)
def test_bounds_within_a_part_are_those_of_the_whole_model_there(space, seed):
    rng = np.random.default_rng(seed)
    model = Trees.random(seed, space, 3)
    lower, upper = box(space, rng)
    corners = np.sort(rng.uniform(lower, upper, (2, len(lower))), axis=0)
    whole, part = (
        [tuple(np.full(SHAPE, value) for value in end) for end in ends] for ends in ((lower, upper), corners)
    )
    fewer = model.bounds.within(*whole)
    assert fewer.effort <= model.bounds.effort
    assert fewer.lower_bound(*part, 1.0) == pytest.approx(model.bounds.lower_bound(*part, 1.0))
    assert fewer.upper_bound(*part) == pytest.approx(model.bounds.upper_bound(*part))
