"""Tells which models are stale: episodes of today's source are others than those that they were trained on.

A changed file need not change an episode. Where the source differs, a card's first episodes are run again: if they end
as they did, the model is still true.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil
from pathlib import Path

import numpy as np

from tailor.executive import domains
from tailor.models.cards.card import Card
from tailor.models.episodes.sources import end_of
from tailor.schemas.installed.changed_source import changed_files
from tailor.schemas.installed.episode_files import episode_files
from tailor.tools.cli.word_lists import abbreviated
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.lockstep.bodies import body_of

END_TOLERANCE = 1e-4  # seconds, metres, radians: other builds of the physics round otherwise
NAMED = 4  # files that a message names


def is_stated(card: Card) -> bool:
    """Whether a card states the source of its episodes; those of older versions and of other tools do not."""
    return bool(card["episodes"].get("source_files"))


def staleness(card: Card) -> str:
    """What differs between a model's episodes and those of today's source; empty if nothing does, or if unknown."""
    if not is_stated(card):
        return "its card does not state the source of its episodes" if "source_sha256" in card["episodes"] else ""
    changed = changed_files(card["episodes"], todays_files(random_episodes.domain_of(card["robot"])))
    if not changed:
        return ""
    differing = differing_episodes(card)
    return (
        f"{abbreviated(changed, NAMED)} changed since its episodes were simulated, and {differing}" if differing else ""
    )


def differing_episodes(card: Card) -> str:
    """How the first episodes of a card differ today, in words; empty if they do not."""
    probe = card["episodes"].get("probe")
    if probe is None:
        return "it holds no random episodes to compare"
    name, action = random_episodes.domain_of(card["robot"]), card["action"]
    domain = domains.load(name)
    if action not in domain.actions:
        return f"{name} has no action '{action}'"
    ends, objects = probe["ends"], probe.get("objects", 0)
    drawn = (len(ends), probe["seed"], Path(), probe["stream"], bool(probe.get("beside")), objects)
    spec = DataSetSpec(name, action, *drawn, probe.get("profile", ""))
    runs = range(ceil(len(ends) / max(1, objects)))
    episodes, _ = random_episodes.run_episodes(spec, domain, body_of(name, spec.profile), runs)
    for number, (episode, then) in enumerate(zip(episodes, ends, strict=False)):
        now = end_of(episode.duration_s, episode.ticks)
        if len(now) != len(then) or not np.allclose(now, then, rtol=0, atol=END_TOLERANCE):
            return f"random episode {number} now takes {now[0]:.1f} s, {then[0]:.1f} s in the card, or ends elsewhere"
    return ""


todays_files = lru_cache(maxsize=4)(episode_files)  # a check compares several cards
