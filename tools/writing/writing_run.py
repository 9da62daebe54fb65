"""Writes letters in lock-step with the whole executive, and records the arm's sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tailor.executive import domains
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.domains.arm.letters import Point
from tailor.executive.interfaces.models import Models
from tailor.schemas.messages import JointState, Message
from tailor.simnodes.body import Reading
from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.simnodes.world import World
from tailor.tools.lockstep.run import SENDER, Run, run_lockstep
from tailor.tools.writing.writing_mode import WritingMode
from tailor.tools.writing.writing_track import WritingTrack, writing_track


class RecordedBody(PowerCubeBody):
    """The arm's body; records its sensor readings."""

    def __init__(self) -> None:
        super().__init__()
        self.readings: list[Message] = []

    def reset(self, rng: np.random.Generator, start: Mapping[str, float]) -> None:
        """See Body.reset; clears the readings."""
        super().reset(rng, start)
        self.readings = []

    def advance(self, duration_ns: int) -> list[Reading]:
        """See Body.advance."""
        readings = super().advance(duration_ns)
        self.readings += [reading.message for reading in readings if reading.topic in ("joint_states", "currents")]
        return readings


def write(
    text: str, mode: WritingMode, models: Models, seed: int, body: RecordedBody, velocities: Sequence[Point] = ()
) -> tuple[WritingTrack, Run]:
    """Write capitals; the same seed gives the same letters, start and noise in every mode.

    Args:
      text: Capitals.
      mode: See `WritingMode`.
      models: Action models of the arm.
      seed: Of size, start and noise.
      body: Reset here.
      velocities: Of the joints at the first waypoints, rad/s, in place of the executive's choice.
    """
    scenario, start = domains.seeded_scenario("arm", f"{'stops' if mode.stops else 'word'}-{text}", seed)
    places = {label: dict(place) for label, place in scenario.places.items()}
    for place, (wa, wb) in zip(places.values(), velocities, strict=False):
        place |= {"wa": wa, "wb": wb}
    scenario = replace(scenario, places=places)
    # certificates take time and change no measured value
    settings = Settings(seed=seed, refinement=replace(mode.refinement, certify_checks=0))
    context = make_context(domains.load("arm"), scenario, models, settings, SENDER)
    run = run_lockstep(context, World(body, start, seed))
    body.command((0.0, 0.0))
    body.advance(round(0.2e9))  # until the last state is out
    outputs = [message for message in run.messages if not isinstance(message, JointState)]  # the truth is one, too
    return writing_track(mode.name, text, [*body.readings, *outputs]), run
