"""Running a case of the book as a test."""

import pytest

from axlespan.verification.book import run


@pytest.fixture
def check_case():
    """Run a case; every row must be within its tolerance, and what fails is shown as a row."""

    def check(case):
        (report,) = run([case])
        assert report.failure == ""
        wrong = [(row.quantity, row.expected, row.obtained, row.error, row.tolerance)
                 for row in report.rows if not row.ok]  # fmt: skip
        assert wrong == []
        assert report.ok
        return {row.quantity: row for row in report.rows}

    return check
