"""The shared library: found without its SWIG module, every function declared, every error named."""

import ast
import ctypes
import importlib.util
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

import mms
from mms import errors
from mms.binding import library, prototypes
from mms.binding.callbacks import guarded
from mms.binding.value_conversion import decode
from mms.references import object_reference
from mms.values import BitString, Quality, Timestamp, Validity

SOURCES = sorted(Path(mms.__file__).parent.rglob("*.py"))
C_PREFIXES = (
    "Acse", "Client", "Config", "Control", "DataAttribute_", "File", "Ied", "Iso", "LinkedList_", "Mms",
    "ModelNode_", "TLSConfiguration_", "TLSConnection_",
)  # fmt: skip


def _functions_used() -> set[str]:
    names = set()
    for source in SOURCES:
        for node in ast.walk(ast.parse(source.read_text())):
            if isinstance(node, ast.Attribute) and "_" in node.attr and node.attr.startswith(C_PREFIXES):
                names.add(node.attr)
    return names


def test_every_function_used_has_its_types_declared_and_none_is_declared_in_vain() -> None:
    assert _functions_used() == set(prototypes.PROTOTYPES)


def test_the_swig_module_is_never_imported() -> None:
    script = (
        "import sys; from mms.binding import library as x; x.library(); sys.exit('pyiec61850' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_the_wheel_tells_its_version_of_mbed_tls() -> None:
    """Who pins another wheel writes its version here and in docs/how-to/security.md."""
    assert mms.mbed_tls_version() == "3.6.0"
    page = Path(mms.__file__).parents[1] / "docs" / "how-to" / "security.md"
    assert "Mbed TLS 3.6.0" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("content", "version"),
    [
        (b"/build/mbedtls-3.6.8/library/ssl_msg.c\0/build/mbedtls-3.6.8/library/ssl_tls.c", "3.6.8"),
        (b"/build/mbedtls-3.6.8/library/ssl_msg.c\0/build/mbedtls-2.28.0/library/ssl_tls.c", None),
        (b"no path of a source file", None),
    ],
)
def test_a_library_that_cannot_be_asked_is_read(
    tmp_path: Path, content: bytes, version: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "libiec61850.so"
    file.write_bytes(content)
    monkeypatch.setattr(library, "library", lambda: object())
    monkeypatch.setattr(library, "shared_library", lambda: file)
    assert library.mbed_tls_version() == version


def test_a_library_that_can_be_asked_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    class Asked:
        @staticmethod
        def mbedtls_version_get_number() -> int:
            return 0x0306_0C00

    monkeypatch.setattr(library, "library", Asked)
    assert library.mbed_tls_version() == "3.6.12"


def test_a_missing_wheel_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(ImportError, match="pyiec61850-ng is not installed"):
        library.shared_library()


def test_a_wheel_without_the_library_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    class Spec:
        submodule_search_locations = (str(tmp_path / "pyiec61850"),)

    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: Spec)
    with pytest.raises(ImportError, match="found 0"):
        library.shared_library()


def test_a_wheel_of_another_version_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(prototypes.PROTOTYPES, "IedConnection_noSuchFunction", (None, []))
    with pytest.raises(ImportError, match="no function IedConnection_noSuchFunction"):
        library.library.__wrapped__()


@pytest.mark.parametrize(
    "error",
    [
        errors.Timeout("h:1", "read", 20, "no answer"),
        errors.ControlRefused("h:1", "operate", 21, "refused", "blocked by mode"),
        errors.FileSizeMismatch("h:1", "download", 0, "short", 10, 5),
        errors.ModelError("line 3", "a name", "none"),
    ],
)
def test_errors_cross_processes(error: Exception) -> None:
    copy = pickle.loads(pickle.dumps(error))  # noqa: S301 (our own)
    assert (type(copy), str(copy), vars(copy)) == (type(error), str(error), vars(error))


def test_numbers_without_a_name_are_still_told() -> None:
    assert "client error 4711" in str(errors.client_error("h:1", "read", 4711))
    assert "MMS error 4711" in str(errors.file_error("h:1", "read", 4711))


def test_a_callback_that_raises_returns_its_failure_value(caplog: pytest.LogCaptureFixture) -> None:
    def fail() -> int:
        raise KeyError("lost")

    assert guarded(fail, -1)() == -1
    assert "lost" in caplog.text


def test_a_quality_is_its_bits() -> None:
    assert str(Quality(Validity.INVALID, test=True).bits) == "0100000000010"
    assert Quality(Validity.INVALID, overflow=True).bits.integer == 0b110
    assert BitString.of(0b110, 13) == Quality(Validity.INVALID, overflow=True).bits
    assert Quality.of(Quality(Validity.RESERVED, operator_blocked=True).bits).validity is Validity.RESERVED
    assert str(Validity.QUESTIONABLE) == "questionable"
    with pytest.raises(ValueError, match="13 bits, not 2"):
        Quality.of(BitString((True, False)))


def test_a_time_is_its_octets() -> None:
    half = Timestamp(1_700_000_000_500_000_000, 0xE0)
    assert half.octets() == (1_700_000_000).to_bytes(4, "big") + b"\x80\x00\x00\xe0"
    assert Timestamp.of(half.octets()) == half
    assert half.leap_seconds_known
    assert half.clock_failure
    assert Timestamp(999_999_999, 0).octets() == b"\x00\x00\x00\x01" + bytes(4), (
        "rounds up into the next second"
    )


def test_nested_data_beyond_reason_is_refused() -> None:
    lib = library.library()
    lib.MmsValue_createEmptyStructure.restype = ctypes.c_void_p
    lib.MmsValue_createEmptyStructure.argtypes = [ctypes.c_int]
    lib.MmsValue_setElement.restype = None
    lib.MmsValue_setElement.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p]
    outer = inner = lib.MmsValue_createEmptyStructure(1)
    for _ in range(20):
        deeper = lib.MmsValue_createEmptyStructure(1)
        lib.MmsValue_setElement(inner, 0, deeper)
        inner = deeper
    with pytest.raises(ValueError, match="nested deeper"):
        decode(lib, outer)
    lib.MmsValue_delete(outer)


def test_a_control_reference_leaves_room_for_what_the_service_adds() -> None:
    longest = "T1CON/" + "x" * 56
    assert object_reference(longest, room=8)
    with pytest.raises(ValueError, match="too long"):
        object_reference(longest + "x", room=8)
