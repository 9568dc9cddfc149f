"""How the parts of a page become one file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

from axlespan.io.strict_json import json_ready
from axlespan.report.pack import Pack


def assembled(
    template: str, values: Mapping[str, str], content: Mapping[str, Any], pack: Pack, scripts: Sequence[str]
) -> str:
    """Fill a template with texts, the content and the arrays of the page, its style and its scripts."""
    script = "\n".join(_resource(f"page/{name}.js") for name in scripts)
    vendor = [_resource("vendor/uplot/uPlot.iife.min.js")]
    if content.get("space"):
        vendor.append(_resource("vendor/three/three-parts.min.js"))
    parts = {
        **values,
        "style": _resource("vendor/uplot/uPlot.min.css") + _resource("page/page.css"),
        "vendor": "\n".join(f"<script>{_safe(text)}</script>" for text in vendor),
        # in JSON every < may be written so, and none can end the element
        "content": json.dumps(json_ready(content), ensure_ascii=False, separators=(",", ":")).replace(
            "<", "\\u003c"
        ),
        "data": pack.text(),
        "script": _safe(f'(() => {{\n"use strict";\n{script}\n}})();'),
    }
    pieces = _resource(f"page/{template}.html").split("{{")
    found = [pieces[0]]
    for piece in pieces[1:]:
        name, _, rest = piece.partition("}}")
        found += [parts[name], rest]
    return "".join(found)


def _resource(name: str) -> str:
    return files("axlespan.report").joinpath(*name.split("/")).read_text(encoding="utf-8")


def _safe(text: str) -> str:
    """Text that cannot end the script element it stands in."""
    return text.replace("</script", "<\\/script")
