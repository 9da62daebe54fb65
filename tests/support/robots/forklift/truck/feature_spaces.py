"""What the durations of gliding and hoisting depend on."""

from tailor.models.features.features import FeatureSpace, length, quantities


def _gliding(rows, ops):
    return ops.stack(length(rows[[3]] - rows[[0]], rows[[4]] - rows[[1]], ops), rows[[2]], rows[[5]])


def _hoisting(rows, ops):
    return ops.absolute(rows[[1]] - rows[[0]])


SPACES = (
    FeatureSpace(
        "gliding",
        quantities("east:m north:m pace:m/s east_goal:m north_goal:m pace_goal:m/s"),
        quantities("way:m pace:m/s pace_goal:m/s"),
        _gliding,
    ),
    FeatureSpace("hoisting", quantities("height:m height_goal:m"), quantities("rise:m"), _hoisting),
)
