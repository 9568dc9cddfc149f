"""Rules of codes: what a run is measured against, and verdicts with clause, value, limit and source."""

from axlespan.standards.assess import assess
from axlespan.standards.assessment import CHECKS, Assessment
from axlespan.standards.at_rest import AtRest
from axlespan.standards.bridge_facts import BridgeFacts, bridge_facts
from axlespan.standards.verdict import FROM_MEMORY, Verdict, envelope, overall, worst

__all__ = [
    "CHECKS",
    "FROM_MEMORY",
    "Assessment",
    "AtRest",
    "BridgeFacts",
    "Verdict",
    "assess",
    "bridge_facts",
    "envelope",
    "overall",
    "worst",
]
