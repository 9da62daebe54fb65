"""Pictures of one action model: what it predicts against what happened, where it errs, and what it has learned."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from tailor.models.cards.card import UNITS, Card
from tailor.models.episodes.episodes import UNOBSERVED, Episode
from tailor.models.episodes.examples import Examples, success_examples
from tailor.models.episodes.regression_targets import REGRESSION_TARGETS
from tailor.models.inference import OnnxDuration, OnnxSuccess
from tailor.models.training import scores
from tailor.tools.figures.learned_models import regions, shapes
from tailor.tools.figures.learned_models.reports import axis_end, saved
from tailor.tools.learning.known_episodes import known_episodes

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.ticker import MaxNLocator

Model = OnnxDuration | OnnxSuccess
AREA = 300.0  # of the largest marker, in square points


def draw(model: Model, data: Path | None, out: Path) -> list[Path]:
    """Draw all pictures of a model; those that need episodes are drawn from its data set, if there is one.

    Args:
      model: A loaded model.
      data: Folder with a data set per action; None looks in data/ROBOT.
      out: Folder for the PNG files.
    """
    card = model.card
    episodes = known_episodes(card, data)
    pictures: dict[str, Callable[[Any], None]] = {}
    if isinstance(model, OnnxDuration):
        region = regions.region_of(card)
        if region is not None:
            pictures |= {"figure7": lambda figure: shapes.figure7(figure, model, region)}
        if card["test"].get("learning_curve"):
            pictures |= {"learning-curve": lambda figure: _learning_curve(figure, card)}
        target = REGRESSION_TARGETS[card["kind"]]
        observed = [episode for episode in episodes if episode.finished and target.is_recorded(episode)]
        if observed:
            rows = target.examples(observed, 1)
            pictures |= {"predicted-observed": lambda figure: _predicted_observed(figure, model, rows)}
            if region is not None:
                pictures |= {"error-by-region": lambda f: regions.error_by_region(f, model, rows, region)}
    else:
        if regions.region_of(card) is regions.POSES:
            pictures |= {"figure8": lambda figure: shapes.figure8(figure, model)}
        judged = [episode for episode in episodes if episode.failure != UNOBSERVED]
        if judged:
            pictures |= {"reliability": lambda figure: _reliability(figure, model, judged)}
    out.mkdir(parents=True, exist_ok=True)
    name = "-".join(card[key] for key in ("robot", "action", "kind"))
    return [_save(out / f"{name}-{each}.png", name.replace("-", "/"), fill) for each, fill in pictures.items()]


def _save(path: Path, title: str, fill: Callable[[Any], None]) -> Path:
    figure = plt.figure(figsize=(9, 4.5), layout="constrained")
    figure.suptitle(title, fontsize="medium", fontweight="bold")
    fill(figure)
    return saved(figure, path)


def _predicted_observed(figure: Any, model: OnnxDuration, rows: Examples) -> None:
    predicted, spread = model.predict(rows.arguments)
    axes, right = figure.subplots(1, 2)
    limit = axis_end(rows.targets)
    axes.scatter(predicted, rows.targets, s=5, alpha=0.4)
    axes.plot([0, limit], [0, limit], color="black", lw=1)
    unit = UNITS[model.card["kind"]]
    axes.set(xlabel=f"predicted [{unit}]", ylabel=f"observed [{unit}]", xlim=(0, limit), ylim=(0, limit))
    axes.set_title("first ticks of the episodes it was fitted to", fontsize="medium")
    errors = np.abs(predicted - rows.targets)
    right.scatter(spread, errors, s=5, alpha=0.4)
    widest, largest = axis_end(spread), axis_end(errors)
    right.plot([0, widest], [0, widest], color="black", lw=1, label="as large as the spread")
    right.set(xlabel=f"spread [{unit}]", ylabel=f"|error| [{unit}]", xlim=(0, widest), ylim=(0, largest))
    right.set_title("is it sure when right?", fontsize="medium")
    right.xaxis.set_major_locator(MaxNLocator(5))
    right.legend(loc="upper right", fontsize="small")


def _learning_curve(figure: Any, card: Card) -> None:
    axes, test = figure.subplots(), card["test"]
    count, error = zip(*test["learning_curve"], strict=True)
    low, high = test["mae_ci95"]
    axes.axhspan(low, high, alpha=0.15, label="95 % interval of the last")
    axes.plot(count, error, marker="o", label="model")
    flat = flat_from(test["learning_curve"], high)
    axes.axvline(flat, color="black", lw=1, ls=":", label=f"flat from {flat}" if flat < count[-1] else "not flat yet")
    axes.set(xlabel="training episodes", ylabel=f"MAE on test episodes [{UNITS[card['kind']]}]", ylim=(0, None))
    axes.set_title("learning curve", fontsize="medium")
    axes.legend()


def flat_from(curve: Sequence[Sequence[float]], high: float) -> int:
    """Training episodes from which on no error leaves the last one's interval, whose upper end is `high`."""
    flat = curve[-1][0]
    for count, error in reversed(curve):
        if error > high:
            break
        flat = count
    return int(flat)


def _reliability(figure: Any, model: OnnxSuccess, episodes: Sequence[Episode]) -> None:
    rows = success_examples(episodes, 1)
    predicted, observed, count = zip(*(model.card["test"].get("reliability") or [(0.0, 0.0, 1)]), strict=True)
    probability = model.probability(rows.arguments)
    axes, right = figure.subplots(1, 2)
    axes.plot([0, 1], [0, 1], color="black", lw=1)
    axes.scatter(predicted, observed, s=AREA * np.array(count) / max(count), zorder=3)
    axes.scatter([], [], s=AREA / 10, color="tab:blue", label="test episodes (area: how many)")
    fitted = scores.reliability(probability, rows.targets > 0.5)
    axes.plot([row[0] for row in fitted], [row[1] for row in fitted], color="tab:orange", label="episodes fitted to")
    axes.set(xlabel="predicted probability of success", ylabel="share that succeeded")
    axes.legend(loc="lower right", fontsize="small")
    right.hist(
        [probability[rows.targets < 0.5], probability[rows.targets > 0.5]], bins=20, label=["failed", "succeeded"]
    )
    right.axvline(model.threshold, color="black", lw=1, label="threshold")
    right.set(xlabel="predicted probability of success", ylabel="episodes")
    right.legend()
