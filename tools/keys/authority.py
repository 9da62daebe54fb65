"""The authority of a deployment: signs the certificate of each name (X.509, P-256; mutual TLS on the bus)."""

from __future__ import annotations

import ipaddress
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from tailor.runtime.bus.rights.credentials import AUTHORITY, CERTIFICATE, PRIVATE_KEY
from tailor.runtime.stopping import undone_before_the_end
from tailor.schemas.errors import UsageError
from tailor.tools.keys.registry import AUTHORITY_KEY

CLOCK_SKEW = timedelta(days=1)  # machines whose clock was never set are common on robots


class Authority:
    """Certificate and private key that sign all others."""

    def __init__(self, certificate: x509.Certificate, key: ec.EllipticCurvePrivateKey) -> None:
        self._certificate, self._key = certificate, key

    @classmethod
    def of(cls, keys: Path, now: datetime, days: int) -> Authority:
        """The authority in a folder, made now if there is none.

        Raises:
          UsageError: One of its two files is missing or damaged, or they are of two authorities. A new one would make
            the keys of the old one useless.
        """
        files = (keys / AUTHORITY, keys / AUTHORITY_KEY)
        missing = [file for file in files if not file.exists()]
        if len(missing) == 1:
            raise UsageError(f"{missing[0]}: is missing, expected it in its place: it belongs to the keys made so far")
        if missing:
            _make(keys, now, days)
        try:
            certificate = x509.load_pem_x509_certificate(files[0].read_bytes())
            key = serialization.load_pem_private_key(files[1].read_bytes(), None)
        except (ValueError, TypeError) as error:  # TypeError: somebody has encrypted it
            raise UsageError(f"{files[0]}, {files[1]}: cannot be read as PEM: {error}") from error
        if not isinstance(key, ec.EllipticCurvePrivateKey) or certificate.public_key() != key.public_key():
            raise UsageError(f"{files[1]}: is not the key of {files[0]}, expected the two that were made together")
        return cls(certificate, key)

    def issue(self, folder: Path, name: str, hosts: Sequence[str], now: datetime, days: int) -> None:
        """Write key and certificate of a name, and the authority's certificate, into a new folder.

        Args:
          folder: New folder.
          name: Common name.
          hosts: Names and addresses at which the others reach it; only a router needs any.
          now: Time of the issue.
          days: Days for which it is valid.
        """
        key = ec.generate_private_key(ec.SECP256R1())
        names = x509.SubjectAlternativeName([_host(host) for host in (*hosts, name)])
        usage = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.CLIENT_AUTH, ExtendedKeyUsageOID.SERVER_AUTH])
        builder = _builder(name, key.public_key(), now, days).issuer_name(self._certificate.subject)
        builder = builder.add_extension(names, critical=False).add_extension(usage, critical=False)
        signed = builder.add_extension(x509.BasicConstraints(False, None), critical=True).sign(
            self._key, hashes.SHA256()
        )
        folder.mkdir(mode=0o700)
        (folder / AUTHORITY).write_bytes(_pem(self._certificate))
        (folder / CERTIFICATE).write_bytes(_pem(signed))
        _write_key(folder / PRIVATE_KEY, key)


def _make(keys: Path, now: datetime, days: int) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    builder = _builder("tailor authority", key.public_key(), now, days)
    builder = builder.issuer_name(x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "tailor authority")]))
    signed = builder.add_extension(x509.BasicConstraints(True, 0), critical=True).sign(key, hashes.SHA256())
    keys.mkdir(mode=0o700, parents=True, exist_ok=True)
    with _both_or_none(keys / AUTHORITY, keys / AUTHORITY_KEY):
        (keys / AUTHORITY).write_bytes(_pem(signed))
        _write_key(keys / AUTHORITY_KEY, key)


@contextmanager
def _both_or_none(*files: Path) -> Iterator[None]:
    """Remove new files if the block that writes them fails, or a signal ends it: one of them would bar all others."""
    with undone_before_the_end():
        try:
            yield
        except BaseException:
            for file in files:
                file.unlink(missing_ok=True)
            raise


def _builder(name: str, key: ec.EllipticCurvePublicKey, now: datetime, days: int) -> x509.CertificateBuilder:
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])
    builder = x509.CertificateBuilder().subject_name(subject).public_key(key)
    builder = builder.serial_number(x509.random_serial_number())
    return builder.not_valid_before(now - CLOCK_SKEW).not_valid_after(now + timedelta(days=days))


def _host(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)


def _pem(certificate: x509.Certificate) -> bytes:
    return certificate.public_bytes(serialization.Encoding.PEM)


def _write_key(path: Path, key: ec.EllipticCurvePrivateKey) -> None:
    data = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(data)


def utc_now() -> datetime:
    """The time of an issue."""
    return datetime.now(UTC)
