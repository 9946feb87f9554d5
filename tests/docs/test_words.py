"""No page, command, message, mail or report says what people do not understand: WORDS is the list."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).parents[2]
ROOMS: Final = ("core", "service", "scl", "mms")

WORDS: Final = {
    r"commission me": "Needs commissioning",
    r"no change is seen": "No fault detected",
    r"the reference holds": "Baseline: 16 recordings",
    r"asymmetry that stands": "Initial asymmetry",
    r"would be seen|\bseen from\b": "Detection limit",
    r"could tell: see the reasons": "Recordings too short",
    r"which cause it is": "Diagnosis",
    r"nothing is known of": "Not assessed: rotor",
    r"uneven rotor": "Rotor bar or end-ring defect",
    r"wrong voltage channel": "VT measurement error",
    r"wrong current channel": "CT measurement error",
    r"asymmetry of the rotor": "Rotor bar severity",
    r"ripple of the air gap": "Air-gap eccentricity indicator",
    r"swing of the torque": "Largest torque oscillation",
    r"inductance is another|the leakage is another|transformer is another": "Magnetising inductance changed",
    r"backward-turning": "Negative-sequence current",
    r"\bfeign": "Can look like",
    r"condition fault": "Stator fault",
    r"its schedule is": "Scheduled every minute",
    r"nobody reads what": "Do not reply",
    r"\bbring (a|another|it)\b": "Upload recording",
    r"\bkeep it\b|it was wrong": "Save note, Retract note",
    r"accept the motor": "Reset baseline",
    r"judged? the motor anew": "Restart assessment",
    r"other than its scl": "SCL mismatches",
    r"files (that are )?not taken": "Ignored files",
    r"gateway that visited": "Service restarting",
    r"another password": "Change password",
    r"alarms that called": "Alarms raised",
    r"how the condition changed": "Condition history",
    r"since when is not known": "Present since monitoring began",
    r"shorted turns in no phase": "Asymmetry of unknown cause",
    r"nobody is called": "(say who is notified)",
}
"""What is not to be said, and what to say instead."""

NOT_YET: Final = {
    "core/classification/amplitude.py": 1,
    "core/classification/classification.py": 1,
    "core/condition/verdict/reasons.py": 5,
    "core/diagnosis/causes.py": 3,
    "core/machines/typical.py": 1,
    "core/rotor/judgement.py": 2,
    "core/rotor/starts.py": 2,
    "core/rotor/trend.py": 2,
    "core/starts/changes.py": 1,
    "core/starts/examining.py": 1,
    "service/condition/wording.py": 3,
    "service/web/templates/macros.html": 1,
}
"""Files that still say so many of them. A number that is too large is an error too: it only goes down."""


def sentences(path: Path) -> Iterator[str]:
    """What a file shows to people; of a program its texts, and the descriptions of commands."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        text = re.sub(r"\{#.*?#\}", " ", text, flags=re.DOTALL)
        yield from re.findall(r'"([^"{}<>]*\s[^"{}<>]*)"', text)
        plain = re.sub(r"\{\{.*?\}\}|\{%.*?%\}", " ", text, flags=re.DOTALL)
        yield from re.sub(r"<[^>]*>", "\n", plain).splitlines()
    elif path.suffix == ".js":
        text = re.sub(r"//.*|/\*.*?\*/", "", text)
        yield from ("".join(one) for one in re.findall(r'"([^"\n]* [^"\n]*)"|`([^`\n]* [^`\n]*)`', text))
    else:
        tree = ast.parse(text)
        hidden = set() if "commands" in path.parts else set(map(id, _descriptions(tree)))
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in hidden:
                words = " ".join(node.value.split())
                yield from [words] if " " in words else []  # one word is a name


def _descriptions(tree: ast.AST) -> Iterator[ast.expr]:
    """The docstrings of a module, and the texts below constants."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value


def shown_files() -> Iterator[Path]:
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*")):
            is_ours = not {"vendor", "site"} & set(path.parts)  # site: the help pages, made of docs
            if path.suffix in (".py", ".html", ".js") and is_ours:
                yield path


@pytest.fixture(scope="module")
def found() -> dict[str, list[str]]:
    """By file, what it says that is not to be said."""
    hits: dict[str, list[str]] = {}
    for path in shown_files():
        for sentence in sentences(path):
            for words, better in WORDS.items():
                if re.search(words, sentence, re.IGNORECASE):
                    name = path.relative_to(ROOT).as_posix()
                    hits.setdefault(name, []).append(f"{sentence.strip()!r}: better {better!r}")
    return hits


def test_nothing_shown_has_a_word_of_the_list(found: dict[str, list[str]]) -> None:
    counted = Counter({name: len(hits) for name, hits in found.items()})
    new = {name: found[name] for name, number in counted.items() if number > NOT_YET.get(name, 0)}
    assert new == {}
    assert {name: counted[name] for name in NOT_YET} == NOT_YET, "fewer than before: lower the number"


def test_the_list_finds_what_a_page_a_script_and_a_command_say(tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text('<p title="Keep it">{{ x }} Bring a recording</p>{# keep it #}')
    (tmp_path / "page.js").write_text('say("it was wrong"); // keep it\n')
    (tmp_path / "module.py").write_text('"""Keep it."""\nX = f"the reference holds {1}"\n')
    shown = {path.suffix: " ".join(sentences(path)).lower() for path in tmp_path.iterdir()}
    assert "keep it" in shown[".html"]
    assert "bring a recording" in shown[".html"]
    assert "it was wrong" in shown[".js"]
    assert "keep it" not in shown[".js"]
    assert "the reference holds" in shown[".py"]
    assert "keep it" not in shown[".py"]
