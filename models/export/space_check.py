"""Checks a feature space before anything is learned in it: does it compute what it declares, also when exported?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from tailor.models.episodes.episodes import Episode
from tailor.models.export.onnx_features import add_features
from tailor.models.export.onnx_graph import Graph
from tailor.models.features.features import FeatureSpace
from tailor.models.inference import open_session
from tailor.schemas.installed import part
from tailor.schemas.installed.package_errors import raised_text
from tailor.schemas.packages.spec import DomainSpec

ROWS = 64  # random arguments, from -1 to 1
USABLE = "arithmetic, row indices such as rows[[0]] and Operations"


def faults_of_spaces(spec: DomainSpec) -> Iterator[str]:
    """What is wrong with the feature spaces that a package declares, one line for each."""
    yield from filter(None, map(fault_of_space, part(spec, "features") if spec.features else ()))


def fault_of_space(space: FeatureSpace) -> str:
    """What is wrong with a feature space, in one line; "" if nothing is.

    A space that numpy computes may still not be exported, and nobody would know before a model has been trained.
    """
    arguments = np.random.default_rng(0).uniform(-1, 1, (ROWS, len(space.arguments)))
    try:
        computed = space(arguments)
    except Exception as error:  # of the package's code: any
        return f"feature space '{space.name}': {raised_text(error)}"
    if computed.shape != (expected := (ROWS, len(space.features))):
        return f"feature space '{space.name}' computes an array of shape {computed.shape}, expected {expected}"
    if computed.dtype != np.float32:
        return f"feature space '{space.name}' computes {computed.dtype}, expected float32: use plain floats"
    try:
        exported = _exported(space, arguments)
    except Exception as error:
        return f"feature space '{space.name}' cannot be exported, expected {USABLE}: {raised_text(error)}"
    for quantity, mine, its in zip(space.features, computed.T, exported, strict=True):
        if not np.array_equal(mine, its, equal_nan=True):
            return f"feature space '{space.name}': {quantity.name} is another number when exported, expected {USABLE}"
    return ""


def fault_in_data(space: FeatureSpace, episodes: Sequence[Episode]) -> str:
    """Where a feature of an episode's tick is not finite, which no learner takes, in one line; "" if all are."""
    for episode in episodes:
        bad = ~np.isfinite(features := space(episode.ticks))
        if bad.any():
            tick, column = np.argwhere(bad)[0].tolist()
            given = zip(space.arguments, episode.ticks[tick].tolist(), strict=True)
            at = ", ".join(f"{quantity.name} = {value:g}" for quantity, value in given)
            what = f"{space.features[column].name} is {features[tick, column]:g}"
            return f"feature space '{space.name}': {what} in episode {episode.number}, expected a number; {at}"
    return ""


def _exported(space: FeatureSpace, arguments: NDArray[np.float64]) -> list[NDArray[np.float32]]:
    """The features as the runtime computes them: one array for each."""
    graph = Graph()
    rows = add_features(graph, space, "arguments")
    outputs = {
        f"feature{k}": graph.add("Gather", rows, graph.constant(np.array(k))) for k in range(len(space.features))
    }
    model = graph.model(len(space.arguments), outputs, {})
    features: list[NDArray[np.float32]] = open_session(model.SerializeToString()).run(None, {"arguments": arguments})
    return features
