"""What the durations of rolling and squeezing depend on."""

from tailor.models.features.features import FeatureSpace, quantities


def _rolling(rows, ops):
    return ops.stack(ops.absolute(rows[[2]] - rows[[0]]), rows[[1]], rows[[3]])


def _squeezing(rows, ops):
    return ops.absolute(rows[[1]] - rows[[0]])


SPACES = (
    FeatureSpace(
        "rolling",
        quantities("along:m pace:m/s along_goal:m pace_goal:m/s"),
        quantities("way:m pace:m/s pace_goal:m/s"),
        _rolling,
    ),
    FeatureSpace("squeezing", quantities("width:m width_goal:m margin_goal:m"), quantities("change:m"), _squeezing),
)
