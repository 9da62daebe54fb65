"""Topics of the soccer robot alone."""

from __future__ import annotations

from tailor.schemas.messages.soccer import BallPercept, SoccerGroundTruth
from tailor.schemas.packages.topic import Topic

TOPICS = {
    "ball": Topic("{robot}/ball", BallPercept, 12.5, "driver"),
    "truth": Topic("{robot}/sim/truth", SoccerGroundTruth, 10, "simulator"),
}
