"""The reference cases: runs the validation tests and reads the values that they print."""

import dataclasses
import re
import subprocess

from ..paths import REFERENCE_DATA, REFERENCE_TESTS, REPOSITORY
from ..report_items import Check, Section, Table

NAME = 'ref'
NUMBER = r'[-+]?(?:\d[\d.]*(?:e[-+]?\d+)?|nan|inf)'
# As Judge() in test/validation/reference_case.h prints it.
LINE = re.compile(
    rf'^(?P<name>\S.*?)\s+(?P<value>{NUMBER}), reference\s+(?P<reference>\S+), '
    rf'error\s+(?P<error>{NUMBER})(?P<unit> %)?, tolerance (?P<tolerance>{NUMBER})(?: %)?, '
    r'(?P<verdict>PASS|FAIL)$')


def parse_line(line):
    """The check that a line holds; None if it is another line."""
    match = LINE.match(line.rstrip())
    if not match:
        return None
    name, _, unit = match['name'].partition(' [')
    return Check(NAME, name, float(match['value']), match['reference'], float(match['error']),
                 float(match['tolerance']), match['verdict'] == 'PASS', unit.rstrip(']'),
                 '%' if match['unit'] else unit.rstrip(']'))


@dataclasses.dataclass(frozen=True)
class ReferenceTest:
    """One test of the binary. It exits with 1 if a value is further off than it was when it was
    written; the lines that it prints tell more."""
    test: str
    alone: bool = False
    cost: float = 15.0

    @property
    def id(self):
        return f'reference_{self.test}'.replace('/', '_')

    def command(self, _folder):
        return [REFERENCE_TESTS.relative_to(REPOSITORY), f'--gtest_filter={self.test}']

    def inputs(self):
        return [REFERENCE_TESTS, *sorted(REFERENCE_DATA.iterdir()),
                *sorted((REPOSITORY / 'meshes').glob('*.msh'))]

    def allowed(self):
        return (0,)


def list_tests():
    """Names of the binary's tests."""
    output = subprocess.run([REFERENCE_TESTS, '--gtest_list_tests'], check=True,
                            stdout=subprocess.PIPE, universal_newlines=True).stdout
    tests, suite = [], ''
    for line in output.splitlines():
        word = line.split('#')[0].strip()
        if line.startswith('  '):
            tests.append(suite + word)
        elif word.endswith('.'):
            suite = word
    return tests


def jobs(_quick):
    return [ReferenceTest(test) for test in list_tests()]


def evaluate(results, quick):
    checks = []
    for job in jobs(quick):
        if job in results.records:
            text = (results.folder(job) / 'output.log').read_text(encoding='utf-8')
            values = [check for check in map(parse_line, text.splitlines()) if check]
            # A test that says nothing proves nothing.
            checks += values or [Check(NAME, f'{job.test}: values printed', 0, '>= 1', -1, 0,
                                       False)]
    rows = [(c.name, c.unit, c.value, c.reference, c.error, c.tolerance, c.error_unit,
             'pass' if c.passed else 'FAIL') for c in checks]
    table = Table('reference', 'All values of the reference cases',
                  [('case', ''), ('unit', ''), ('value', '.6g'), ('reference', ''),
                   ('error', '+.3f'), ('tolerance', 'g'), ('of error', ''), ('verdict', '')], rows)
    return Section(NAME, 'Reference cases', [
        'Beam, disc, dome and cup against converged solutions of CalculiX, an independent '
        'finite-element code. A reference of two values is the spread between the St. Venant-'
        'Kirchhoff and the neo-Hookean material, in which a linear co-rotational one is expected; '
        'the error is the distance from it.'], [], [table], checks)
