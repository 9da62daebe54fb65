"""Recipes: how the models of a robot are made from seeds."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from tailor.tools.learning.gather_options import HORIZON, POOL, UNCERTAIN_POOL

MAX_SEED = 1_000_000_000  # a learner of several networks multiplies it, and scikit-learn takes 32 bits


@dataclass(frozen=True, slots=True)
class Round:
    """Episodes that the models trained so far choose.

    Attributes:
      source: "on-policy": runs of the executive; "active": its choices on which the models disagree most.
      scenarios: Scenarios that are run, or from which situations are drawn.
      episodes: Runs of each scenario; of an active round episodes of each action.
      pool: Of an active round: situations that are drawn for each episode.
      horizon: Of an on-policy round: actions that are optimised together. With 1 choices are greedy: what refinement
        is compared with, where it decides whether to leave it.
    """

    source: Literal["on-policy", "active"]
    scenarios: tuple[str, ...]
    episodes: int
    pool: int = POOL
    horizon: int = HORIZON

    @property
    def situations(self) -> int:
        """Number of situations in which models choose."""
        return self.episodes * (self.pool if self.source == "active" else len(self.scenarios))


@dataclass(frozen=True, slots=True)
class Calibration:
    """Runs with the models of all other episodes, to correct their intervals; only successes are learned from them.

    Attributes:
      scenarios: Scenarios that are run.
      episodes: Runs of each scenario.
    """

    scenarios: tuple[str, ...]
    episodes: int

    @property
    def situations(self) -> int:
        """Number of runs."""
        return self.episodes * len(self.scenarios)


@dataclass(frozen=True, slots=True)
class RandomEpisodes:
    """Number of random episodes of an action that needs another one than most."""

    action: str
    episodes: int


@dataclass(frozen=True, slots=True)
class UncertainEpisodes:
    """Random episodes whose success the models of the random ones are least certain of.

    Attributes:
      action: An action with a model of success.
      episodes: Their number.
      pool: Tasks that are drawn for each of them.
    """

    action: str
    episodes: int
    pool: int = UNCERTAIN_POOL


@dataclass(frozen=True, slots=True)
class OwnLearner:
    """Learner of the durations and energies of an action that needs another one than most, or another feature space.

    What is empty is as for all actions.
    """

    action: str
    learner: str = ""
    features: str = ""


@dataclass(frozen=True, slots=True)
class Training:
    """Options of `tailor train`, kinds of models, what single actions need; empty: its defaults, all kinds."""

    kinds: tuple[Literal["duration", "success", "clearance", "energy", "duration_beside"], ...] = ()
    features: str = ""
    energy_features: str = ""
    learner: str = ""
    failure_learner: str = ""
    clearance_learner: str = ""
    learners: tuple[OwnLearner, ...] = ()
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Recipe:
    """How the models of a robot are made.

    Attributes:
      episodes: Random episodes of each action,
      random: but for these.
      beside: Random runs beside objects, of each action that has a model of success beside an object.
      objects: Objects noted after each of these runs, an episode each (see `beside_objects.py`); 0: one that is
        there while it runs.
      uncertain: Episodes that follow, of actions that seldom fail.
      seed: Of all random draws of gathering.
      rounds: Rounds that follow, each with the models trained on all episodes before it.
      calibration: Runs after all rounds.
      training: How each model is trained.
      profile: Of the body; empty: the usual one.
    """

    episodes: int
    beside: int = 0
    objects: int = 0
    seed: int = 7
    random: tuple[RandomEpisodes, ...] = ()
    uncertain: tuple[UncertainEpisodes, ...] = ()
    rounds: tuple[Round, ...] = ()
    calibration: tuple[Calibration, ...] = ()
    training: Training = field(default_factory=Training)
    profile: str = ""

    def episodes_of(self, action: str) -> int:
        """Number of random episodes of an action."""
        return next((each.episodes for each in self.random if each.action == action), self.episodes)

    @property
    def chosen(self) -> list[tuple[str, Round | Calibration]]:
        """All that models choose, each with its name in the file."""
        return [*(("rounds", each) for each in self.rounds), *(("calibration", each) for each in self.calibration)]
