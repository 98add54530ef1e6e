"""Fits and records -> text, Markdown."""
