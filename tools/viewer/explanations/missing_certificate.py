"""Why nothing is known of how near a choice is to the optimum of its models."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.certificates.certificate import certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import MAX_GAP_PCT
from tailor.schemas.messages import Contexts, RefinementReport, Subgoals
from tailor.tools.viewer.explanations.decided_sequence import accepted, chosen_values, objective_of, sequence_of


def why_not_certified(
    message: Subgoals,
    library: Mapping[str, Action],
    models: Models,
    settings: RefinementSettings,
    report: RefinementReport | None,
    objects: Contexts | None = None,
) -> str:
    """The reason for people, of a decision without a certificate; what the executive did not record it cannot tell."""
    if settings.certify_checks == 0:
        return "certify_checks is 0"
    sequence, chosen = sequence_of(message, library, objects), chosen_values(message)
    if sequence is None:
        return "its actions are not those of the library"
    settings = replace(settings, horizon=min(message.horizon, len(sequence.actions)))
    objective = objective_of(accepted(sequence, chosen, models, settings), models, settings)
    choice = objective.vector(chosen)
    if not math.isfinite(objective(choice[None])[0]):
        return "the choice is predicted to fail"
    proof = certificate(objective, choice, settings)
    if isinstance(proof, NoBound):
        return proof.reason
    if report is None or not report.finished:
        return "the search was interrupted before a proof began"
    return f"no gap of at most {MAX_GAP_PCT:g} % was proven in the time that the search had left"
