"""All numbers of the report as CSV files, in full precision."""

import csv

from .paths import RESULTS

CHECK_COLUMNS = ('part', 'name', 'value', 'unit', 'reference', 'error', 'tolerance', 'error_unit',
                 'verdict')


def check_row(check):
    return (check.part, check.name, check.value, check.unit, check.reference, check.error,
            check.tolerance, check.error_unit, 'pass' if check.passed else 'FAIL')


def write(name, columns, rows):
    RESULTS.mkdir(parents=True, exist_ok=True)
    with open(RESULTS / f'{name}.csv', 'w', newline='', encoding='utf-8') as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(rows)


def write_all(sections, failed_runs):
    """A file a table, checks.csv with every tolerance, failed_runs.csv."""
    for section in sections:
        for table in section.tables:
            write(table.name, [name for name, _ in table.columns], table.rows)
    write('failed_runs', ('run', 'status', 'last_line'), failed_runs)
    write('checks', CHECK_COLUMNS, [check_row(c) for s in sections for c in s.checks])
