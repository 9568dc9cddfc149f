"""One self-contained HTML page from a stored result: no server, no request, nothing to install to read it."""

from axlespan.report.page import result_page, write_report

__all__ = ["result_page", "write_report"]
