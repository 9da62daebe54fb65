"""Pictures of models: each of what it says it is, for any robot, and none for arguments that nobody drew yet."""

from pathlib import Path

import numpy as np
import pytest

from tailor.models.episodes.examples import Examples
from tailor.models.features.spaces import feature_space
from tailor.models.runtime import load_model
from tailor.tools.figures.learned_models.pictures import _predicted_observed, flat_from, plt
from tailor.tools.figures.learned_models.regions import GEARS, JOINTS, POSES, region_of, swept
from tailor.tools.main import main


@pytest.mark.parametrize(
    ("curve", "high", "flat"),
    [
        ([[100, 0.3], [200, 0.2], [400, 0.19]], 0.21, 200),
        ([[100, 0.3], [200, 0.25], [400, 0.19]], 0.21, 400),  # still falling
        ([[100, 0.2], [200, 0.3], [400, 0.19]], 0.21, 400),  # it was luck
        ([[100, 0.2], [200, 0.2], [400, 0.19]], 0.21, 100),
    ],
)
def test_a_learning_curve_is_flat_from_where_no_error_leaves_the_last_one_s_interval(curve, high, flat) -> None:
    assert flat_from(curve, high) == flat


class Unsure:
    """Predicts 3 s, and a spread far beyond its errors."""

    card = {"kind": "duration"}

    def predict(self, arguments):
        return np.full(len(arguments), 3.0), np.full(len(arguments), 2.0)


def test_errors_fill_the_height_of_their_axis() -> None:
    errors_s = np.linspace(0.0, 0.1, 50)
    rows = Examples(np.zeros((50, 8)), 3.0 + errors_s, np.arange(50))
    figure = plt.figure()
    _predicted_observed(figure, Unsure(), rows)
    low, high = figure.axes[1].get_ylim()
    plt.close(figure)
    assert low == 0.0
    assert errors_s.max() < high < 1.2 * errors_s.max()


@pytest.mark.parametrize("region", [POSES, JOINTS])
def test_the_sweep_turns_the_angle_that_it_names_and_nothing_else(region) -> None:
    angle = np.linspace(-3.0, 3.0, 25)
    features = feature_space(region.space.name)(swept(region, angle))
    names = [quantity.name for quantity in region.space.features]
    turned = names.index(region.swept)
    assert np.allclose(features[:, turned], angle, atol=1e-4)
    assert np.allclose(np.delete(features, turned, axis=1), np.delete(features[:1], turned, axis=1), atol=1e-4)


def test_arguments_that_nobody_drew_have_no_region() -> None:
    arm = load_model("powercube/reach/duration").card
    assert region_of(arm) is GEARS
    assert region_of({"arguments": arm["arguments"][:8]}) is JOINTS
    assert region_of(load_model("agilo/goToPose/duration").card) is POSES
    assert region_of({"arguments": [{"name": "force"}]}) is None


def test_plots_are_named_by_robot_action_and_kind(tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)  # no episodes here
    assert main(["models", "plot", "powercube/reach/energy", "--out", "plots"]) == 0
    drawn = capsys.readouterr().out.split()
    assert drawn == [f"plots/powercube-reach-energy-{name}.png" for name in ("figure7", "learning-curve")]
    assert all(Path(path).stat().st_size > 10_000 for path in drawn)
