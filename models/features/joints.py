"""Feature spaces of two joints (Table 7): from angles and velocities to angles and velocities.

Each also exists for arms that observe the friction of their gears, as multiples of the nominal.
"""

from __future__ import annotations

from tailor.models.features.features import (
    SAME_PLACE,
    FeatureSpace,
    Operations,
    Rows,
    direction,
    length,
    quantities,
    wrap,
)

JOINTS = quantities("a:rad wa:rad/s b:rad wb:rad/s ag:rad wag:rad/s bg:rad wbg:rad/s")
FRICTION = quantities("fa:1 fb:1")


def _joints(rows: Rows, ops: Operations) -> Rows:
    a, wa, b, wb, ag, wag, bg, wbg = (rows[[k]] for k in range(8))
    da, db = ag - a, bg - b
    dist, v, vg = length(da, db, ops), length(wa, wb, ops), length(wag, wbg, ops)
    sight = direction(da, db, dist, 0.0, ops)
    leave = direction(wa, wb, v, sight, ops)  # at rest: the line of sight
    arrive = direction(wag, wbg, vg, sight, ops)
    return ops.stack(v, vg, dist, wrap(ops.stack(sight - leave, arrive - sight), ops))


def _joints_relative(rows: Rows, ops: Operations) -> Rows:
    places = rows[[0, 2]]
    return ops.stack(places, rows[[4, 6]] - places, rows[[1, 3, 5, 7]])


def _joints_lifted(rows: Rows, ops: Operations) -> Rows:
    b, bg, va, vb, vag, vbg = (rows[[k]] for k in (2, 6, 1, 3, 5, 7))
    da, db = rows[[4]] - rows[[0]], bg - b
    dist = length(da, db, ops)
    nearness = 1.0 / (dist + SAME_PLACE)
    ca, cb = da * nearness, db * nearness
    along, across = ca * va + cb * vb, ca * vb - cb * va
    along_g, across_g = ca * vag + cb * vbg, ca * vbg - cb * vag
    # a mirrored pan is the same motion: the sign of what is across changes with it
    mirrored = tuple(ops.where(da < 0.0, row * -1.0, row) for row in (across, across_g))
    return ops.stack(b, ops.absolute(da), db, dist, along, mirrored[0], along_g, mirrored[1])


def _with_friction(space: FeatureSpace) -> FeatureSpace:
    """The same space with friction as two more arguments, which are features as they are."""

    def rows(arguments: Rows, ops: Operations) -> Rows:
        return ops.stack(space.rows(arguments, ops), arguments[[8, 9]])

    return FeatureSpace(f"{space.name}-friction", space.arguments + FRICTION, space.features + FRICTION, rows)


joints = FeatureSpace("joints", JOINTS, quantities("v:rad/s v_g:rad/s dist:rad angle_1:rad angle_2:rad"), _joints)
joints_relative = FeatureSpace(  # for quantities that depend on the joint positions, as gravity does
    "joints-relative",
    JOINTS,
    quantities("a:rad b:rad da:rad db:rad wa:rad/s wb:rad/s wag:rad/s wbg:rad/s"),
    _joints_relative,
)
joints_lifted = FeatureSpace(  # for what depends on gravity at the lift: invariant to turning and mirroring the pan
    "joints-lifted",
    JOINTS,
    quantities("b:rad da:rad db:rad dist:rad along:rad/s across:rad/s along_g:rad/s across_g:rad/s"),
    _joints_lifted,
)
joints_friction = _with_friction(joints)
SPACES = (  # the first that takes an arm's arguments is the default
    *(joints_lifted, joints, joints_relative),
    *(_with_friction(joints_lifted), joints_friction, _with_friction(joints_relative)),
)
