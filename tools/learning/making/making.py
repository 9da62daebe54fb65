"""Models to make of a robot, and the folders of all that is made on the way."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

from tailor.schemas.installed.source import episodes_sha256, learning_sha256, runs_sha256
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.recipe import Recipe

CHOOSING = (
    "duration",
    "duration_beside",
    "success",
    "clearance",
)  # kinds of models that choices depend on, while energies have no price


@dataclass(frozen=True, slots=True)
class Making:
    """Models to make.

    Attributes:
      robot: Name of the robot.
      recipe: How its models are made.
      work: Folder of the episodes and models of all steps.
      jobs: Processes.
      command: Command that makes the same models again, for their cards.
      kinds: Kinds of models to make; empty: the recipe's. Those that only choose further episodes are of `CHOOSING`
        kinds.
    """

    robot: str
    recipe: Recipe
    work: Path
    jobs: int
    command: str
    kinds: tuple[str, ...] = ()

    @property
    def domain(self) -> str:
        """Name of the robot's domain."""
        return random_episodes.domain_of(self.robot)

    @property
    def random(self) -> Path:
        """Folder of the random episodes; other controllers, bodies, profiles or seeds have another one."""
        profile = f"-{self.recipe.profile}" if self.recipe.profile else ""
        return self.work / self.robot / f"random-{episodes_sha256(self.domain)[:12]}-{self.recipe.seed}{profile}"

    @property
    def beside(self) -> Path:
        """Folder of the random episodes beside one object."""
        return self.random.with_name(f"{self.random.name}-beside")

    @property
    def rounds(self) -> Path:
        """Folder of all that depends on learners and refinement, too."""
        about = [runs_sha256(self.domain), episodes_sha256(self.domain), learning_sha256()]
        key = json.dumps([*about, dataclasses.asdict(self.recipe), self.kinds])
        return self.work / self.robot / hashlib.sha256(key.encode()).hexdigest()[:12]

    @property
    def zoo(self) -> Path:
        """Folder of the finished models."""
        return self.rounds / "zoo"

    @property
    def uncertain(self) -> Path:
        """Folder of the random episodes of uncertain success."""
        return self.rounds / "uncertain"

    def chooser(self, number: int) -> Path:
        """Folder of the models that choose the episodes of round `number`, from 0, and after all rounds calibrate."""
        return self.rounds / f"zoo-{number}"

    @property
    def drawn(self) -> list[Path]:
        """Folders with the data sets of random episodes."""
        return [self.random, *([self.uncertain] if self.recipe.uncertain else [])]

    def round(self, number: int) -> Path:
        """Folder with the data sets of round `number`, from 0."""
        return self.rounds / f"round-{number + 1}"

    def data(self, rounds: int) -> list[Path]:
        """Folders with the data sets of random episodes, and of the first rounds."""
        return [*self.drawn, *map(self.round, range(rounds))]

    @property
    def calibration(self) -> list[Path]:
        """Folders with the data sets that correct intervals."""
        return [self.rounds / f"calibration-{k + 1}" for k in range(len(self.recipe.calibration))]
