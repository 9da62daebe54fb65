"""Why nothing is known of how near a choice is to the optimum of its models."""

from __future__ import annotations

import math

from tailor.executive.refinement.certificates.certificate import certificate
from tailor.executive.refinement.certificates.stage_bounds import NoBound
from tailor.executive.refinement.refinement import MAX_GAP_PCT
from tailor.schemas.messages import RefinementReport
from tailor.tools.viewer.explanations.decided_sequence import Decided


def why_not_certified(decided: Decided, report: RefinementReport | None) -> str:
    """The reason for people, of a decision without a certificate; what the executive did not record it cannot tell."""
    if decided.settings.certify_checks == 0:
        return "certify_checks is 0"
    choice = decided.objective.vector(decided.chosen)
    if not math.isfinite(decided.objective(choice[None])[0]):
        return "the choice is predicted to fail"
    proof = certificate(decided.objective, choice, decided.settings)
    if isinstance(proof, NoBound):
        return proof.reason
    if report is None or not report.finished:
        return "the search was interrupted before a proof began"
    return f"no gap of at most {MAX_GAP_PCT:g} % was proven in the time that the search had left"
