"""Sweeps: many scenarios around one case, on a laptop or a cluster."""

from axlespan.study.sweep.answers import Answers, Envelope
from axlespan.study.sweep.study import RunOutcome, Scenario, Study

__all__ = ["Answers", "Envelope", "RunOutcome", "Scenario", "Study"]
