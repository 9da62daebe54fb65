"""Training on episodes that robots of others bring: nearly all selected, or of durations that are hours."""

from dataclasses import replace

import numpy as np
import pytest

from tailor.models import runtime
from tailor.models.cards.card import card_path, read_card, write_card
from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.export.publishing import Publication, publish
from tailor.models.features.planar import projective
from tailor.models.training.training import train_duration
from tailor.schemas.errors import UsageError
from tests.support import standin

pytestmark = pytest.mark.usefixtures("few_first_ticks")

ARGUMENTS = [{"name": q.name, "unit": q.unit, "lower": -4.0, "upper": 4.0} for q in projective.arguments]


def data_set(count: int) -> DataSet:
    made = standin.episodes(count, 1)
    episodes = tuple(Episode(k, t[0], t, d, ok, "" if ok else "ball") for k, (t, d, ok) in enumerate(made))
    return DataSet({"robot": "toy", "action": "goToPose", "arguments": ARGUMENTS}, episodes, "0" * 64)


@pytest.mark.filterwarnings("error")
def test_selected_episodes_judge_intervals_where_hardly_any_other_is_there() -> None:
    """A quarter of three episodes may be none to test on, and one error would be the width of every interval."""
    episodes = data_set(240).episodes
    nearly_all, none, fewer = (
        train_duration([replace(e, selected=e.number >= usual) for e in episodes], projective, "linear", 3)
        for usual in (3, 240, 40)
    )
    assert nearly_all.test["n"] == none.test["n"] == 60
    rows = projective(np.stack([e.ticks[0] for e in episodes]))
    for ours, those in zip(*(each.learner.predict_interval(rows) for each in (nearly_all, none)), strict=True):
        assert np.array_equal(ours, those)
    assert fewer.test["n"] < 30


@pytest.mark.parametrize("learner", ["linear", "bag"])
def test_a_model_of_long_durations_is_published_and_still_compared_with_its_card(tmp_path, learner) -> None:
    """Single precision knows an hour to 0.2 ms, and 10 kJ to a millijoule: no absolute tolerance suits both."""
    data = data_set(120)
    episodes = tuple(replace(e, duration_s=1000 * e.duration_s) for e in data.episodes)
    trained = train_duration(episodes, projective, learner, 3)
    about = Publication("duration", learner, projective, 3, "tailor train toy")
    path = publish(tmp_path, replace(data, episodes=episodes), trained, about)
    card = runtime.load_model(path).card
    assert max(card["golden"]["mean_s"]) > 5000
    card["golden"]["mean_s"][0] += 1.0
    write_card(card_path(path), {**read_card(card_path(path)), "golden": card["golden"]})
    with pytest.raises(UsageError, match="golden example 0 gives mean_s"):
        runtime.load_model(path)
