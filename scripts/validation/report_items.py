"""What the parts hand to the report: checks, tables, figures, sections."""

import dataclasses
from typing import List


@dataclasses.dataclass(frozen=True)
class Check:
    """A tolerance that holds or not. Numbers are in `unit`, error and tolerance in `error_unit`."""
    part: str
    name: str
    value: float
    reference: str
    error: float
    tolerance: float
    passed: bool
    unit: str = ''
    error_unit: str = ''


def check_small(part, name, value, limit, unit=''):
    """A value that should be zero and must not be above a limit; NaN is."""
    return Check(part, name, value, '0', value, limit, bool(value <= limit), unit, unit)


def check_equal(part, name, value, expected):
    """A count."""
    return Check(part, name, value, f'{expected:g}', value - expected, 0.0, value == expected)


def check_relative(part, name, value, reference, tolerance_percent, unit=''):
    """A change in percent of a reference value; NaN fails."""
    error = 100.0 * (value / reference - 1.0)
    return Check(part, name, value, f'{reference:.5g}', error, tolerance_percent,
                 bool(abs(error) <= tolerance_percent), unit, '%')


@dataclasses.dataclass(frozen=True)
class Table:
    """Columns are (name with unit, format); rows hold numbers, texts or None. Also a CSV file."""
    name: str
    title: str
    columns: List
    rows: List


@dataclasses.dataclass(frozen=True)
class Figure:
    """A file of results/validation/figures and what it shows."""
    name: str
    caption: str


@dataclasses.dataclass
class Section:
    """A chapter of the report. Paragraphs are HTML."""
    name: str
    title: str
    paragraphs: List = dataclasses.field(default_factory=list)
    figures: List = dataclasses.field(default_factory=list)
    tables: List = dataclasses.field(default_factory=list)
    checks: List = dataclasses.field(default_factory=list)
