"""Pages that the build writes from the package itself, so that they cannot be out of date."""

from __future__ import annotations

from pathlib import Path

import field_comments
import made_api
import made_book
import made_case_file
import made_commands
import made_library
from sphinx.application import Sphinx

PAGES = {
    "case-file.md": made_case_file.page,
    "commands.md": made_commands.page,
    "verification.md": made_book.page,
    "library.md": made_library.page,
    "api.md": made_api.page,
}


def write(app: Sphinx) -> None:
    """Write what has changed, so that an incremental build stays quick."""
    folder = Path(app.srcdir) / "made"
    folder.mkdir(exist_ok=True)
    for name, page in PAGES.items():
        text = page(folder / name)
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before sources are looked for."""
    app.connect("builder-inited", write)
    # Before and after napoleon reads docstrings.
    app.connect("autodoc-process-docstring", field_comments.tell, priority=100)
    app.connect("autodoc-process-docstring", field_comments.keep, priority=100)
    app.connect("autodoc-process-docstring", field_comments.restore, priority=900)
    return {"parallel_read_safe": True}
