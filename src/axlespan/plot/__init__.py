"""Figures: functions of results."""
