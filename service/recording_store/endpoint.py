"""Where an S3-compatible store answers: the URL that boto3 finds in the environment or in a profile."""

from ipaddress import ip_address
from urllib.parse import urlsplit

from service.recording_store.errors import StoreUnreachableError

WANTED = (
    "the endpoint of the S3-compatible store (AWS_ENDPOINT_URL_S3, or endpoint_url of a profile): expected a "
    "URL such as https://minio.example:9000, without a user, a password or a query"
)
"""What was found is not told: it may have a secret in it."""


def require_sound(url: str) -> None:
    """Raise StoreUnreachableError where a URL has more in it than an address: logs and errors tell it."""
    try:
        parts = urlsplit(url)
        is_sound = parts.scheme in {"http", "https"} and bool(parts.hostname)
    except ValueError:
        is_sound = False
    if not is_sound or "@" in parts.netloc or parts.query or parts.fragment:
        raise StoreUnreachableError(f"{WANTED}, found another one")


def goes_in_clear(url: str) -> bool:
    """Return whether others on the network can read what is sent to a sound URL."""
    parts = urlsplit(url)
    return parts.scheme == "http" and not _is_loopback(parts.hostname or "")


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
