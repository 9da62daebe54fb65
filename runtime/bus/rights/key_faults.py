"""What is wrong with the files of a key, in words: zenoh tells only that no session opens.

Each check loads cryptography, so whoever opens a session asks only afterwards, if none has opened: an e-stop must not
wait. The module itself loads none: a bus for this machine alone has no key.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from tailor.runtime.bus.rights.credentials import AUTHORITY, CERTIFICATE, PRIVATE_KEY, Identity
from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    from cryptography import x509

MADE = "expected the files that `tailor keys new` made together"


def check_files(identity: Identity) -> None:
    """Check that the files can be read and belong together.

    Raises:
      UsageError: No session ever opens with them.
    """
    from cryptography.exceptions import InvalidSignature
    from cryptography.hazmat.primitives.serialization import load_pem_private_key

    authority, certificate = (_certificate(identity.folder / name) for name in (AUTHORITY, CERTIFICATE))
    path = identity.folder / PRIVATE_KEY
    try:
        key = load_pem_private_key(_read(path), None)
    except (ValueError, TypeError) as error:  # TypeError: somebody has encrypted it
        raise UsageError(f"{path}: is no private key, {MADE}") from error
    if key.public_key() != certificate.public_key():
        raise UsageError(f"{path}: is not the key of {CERTIFICATE}, {MADE}")
    try:
        certificate.verify_directly_issued_by(authority)
    except (ValueError, TypeError, InvalidSignature) as error:
        raise UsageError(f"{identity.folder / CERTIFICATE}: is not of {AUTHORITY} there, {MADE}") from error


def out_of_date(identity: Identity, now: datetime | None = None) -> str:
    """Why the certificates are not valid at a time, by default now; empty: they are. The clock may be what is wrong."""
    now = now or datetime.now(UTC)
    for path in (identity.folder / AUTHORITY, identity.folder / CERTIFICATE):
        certificate = _certificate(path)
        if now > certificate.not_valid_after_utc:
            return f"{path}: has expired on {certificate.not_valid_after_utc:%Y-%m-%d}"
        if now < certificate.not_valid_before_utc:
            first = f"{certificate.not_valid_before_utc:%Y-%m-%d}"
            return f"{path}: is valid from {first} on, and the clock of this machine shows {now:%Y-%m-%d}"
    return ""


def _certificate(path: Path) -> x509.Certificate:
    from cryptography import x509

    try:
        return x509.load_pem_x509_certificate(_read(path))
    except ValueError as error:
        raise UsageError(f"{path}: is no certificate, {MADE}") from error


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read ({error.strerror}), expected a file of this user") from error
