"""The case file: every section and key, from its JSON Schema."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from axlespan.study.case import schema

INTRODUCTION = """# The case file

Every key, from the schema that `axlespan schema` prints. A number with a unit is written `25 m`, `2.87 GPa`,
`80 km/h`; a bare number is in the SI unit that is named here. Keys without a default must be there. What is
wrong is refused with file, line, column, value, rule and a fix before anything is computed.

"""


def page(_path: Path) -> str:
    """Return the page: the file's own keys first, then every section that they lead to."""
    whole = schema()
    sections = whole["$defs"]
    lines = [INTRODUCTION, "## The file", "", *_table(whole, sections)]
    for name in _in_order(whole, sections):
        section = sections[name]
        lines += [f"({_anchor(name)})=", f"## {_title(name, sections)}", ""]
        about = section.get("description", "").replace("``", "`")
        lines += [about, "", *_table(section, sections)]
    return "\n".join(lines)


def _in_order(whole: dict[str, Any], sections: dict[str, Any]) -> list[str]:
    """Return the names of the sections as one meets them: all kinds of structure, what is in them, the train, ..."""
    found: dict[str, None] = {}

    def meet(entry: Any) -> None:
        if isinstance(entry, list):
            for item in entry:
                meet(item)
        elif isinstance(entry, dict):
            if "$ref" in entry:
                name = entry["$ref"].rsplit("/", 1)[-1]
                if name not in found:
                    found[name] = None
                    meet(sections[name])
            for key in entry:
                if key != "$defs":
                    meet(entry[key])

    meet(whole.get("properties", {}))
    names = [*found, *(name for name in sorted(sections) if name not in found)]
    return [name for name in names if "properties" in sections[name]]


def _anchor(name: str) -> str:
    return f"case-{name.lower()}"


def _title(name: str, sections: dict[str, Any]) -> str:
    """Return what a section is: its kind, with its own name where another one is of that kind too."""
    said = _kind(sections[name])
    alike = [other for other in sections if said and _kind(sections[other]) == said]
    if not said:
        return name
    return said if len(alike) == 1 else f"{said} ({name})"


def _kind(section: dict[str, Any]) -> str:
    properties = section.get("properties", {})
    for key in ("kind", "vehicle"):
        word = properties.get(key, {}).get("const")
        if word:
            return f"{key}: {word}"
    return ""


def _table(section: dict[str, Any], sections: dict[str, Any]) -> list[str]:
    required = section.get("required", [])
    lines = ["| key | what | takes | default |", "|---|---|---|---|"]
    for key, entry in section.get("properties", {}).items():
        default = "required" if key in required else _default(entry)
        about = entry.get("description", "").replace("``", "`")
        example = "".join(f" Example: `{item}`." for item in entry.get("examples", [])[:1])
        cells = (f"`{key}`", about + example, _takes(entry, sections), default)
        lines.append("| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |")
    return [*lines, ""]


def _default(entry: dict[str, Any]) -> str:
    if entry.get("default") in (None, "", {}, []) or isinstance(entry["default"], dict):
        return ""
    value = entry["default"]
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _takes(entry: dict[str, Any], sections: dict[str, Any]) -> str:
    """Return what a key takes, in a few words with links."""
    if "$ref" in entry:
        name = entry["$ref"].rsplit("/", 1)[-1]
        if "properties" not in sections.get(name, {}):
            return _takes(sections[name], sections) if name in sections else name
        word = _title(name, sections).rpartition(": ")[2]
        return f"[{word}](#{_anchor(name)})"
    if "const" in entry:
        return f"`{entry['const']}`"
    if "enum" in entry:
        return ", ".join(f"`{word}`" for word in entry["enum"])
    for key in ("oneOf", "anyOf"):
        if key in entry:
            options = [_takes(option, sections) for option in entry[key] if option.get("type") != "null"]
            return " or ".join(dict.fromkeys(option for option in options if option))
    kind = entry.get("type")
    if kind == "array":
        inner = entry.get("items") or (entry.get("prefixItems") or [{}])[0]
        return f"list of {_takes(inner, sections)}".strip()
    if kind == "object":
        inner = entry.get("additionalProperties")
        return f"mapping to {_takes(inner, sections)}" if isinstance(inner, dict) else "mapping"
    if kind == "number" and entry.get("description", "").startswith("In "):
        return f"number [{entry['description'][3:].rstrip('.')}]"
    if kind == "string" and entry.get("description", "").startswith("With its unit"):
        return ""
    return kind if isinstance(kind, str) else " or ".join(kind or [])
