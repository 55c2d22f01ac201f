"""Runs what the chosen parts need and writes the report."""

import argparse
import os
import signal
import sys
import time

from . import csv_files, meshes, report
from .grip import Grip
from .origin import origin
from .parts import (convergence, cost, force, geometry, loss, measured, reference, seal, sweep,
                    wrinkles)
from .progress import Progress
from .results import Results
from .runner import Runner

PARTS = {part.NAME: part for part in (reference, geometry, force, sweep, convergence, cost, seal,
                                      loss, wrinkles, measured)}


def count(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f'is {text}, must be 1 or more')
    return number


def parse(words):
    parser = argparse.ArgumentParser(
        prog='validate', description='Compares the simulation with the reference solutions, '
        'repeats the experiments of the paper and studies convergence and cost; writes '
        'results/validation/report.html. Exit status: 0 if every tolerance holds and every run '
        'succeeded, 1 if not, 2 for bad arguments.')
    parser.add_argument('--quick', action='store_true', help='only what the main claims need')
    parser.add_argument('--only', action='append', choices=PARTS, metavar='PART',
                        help=f'one of {", ".join(PARTS)}; may be given several times')
    parser.add_argument('--fresh', action='store_true', help='repeat runs that are finished')
    parser.add_argument('--jobs', type=count, default=os.cpu_count(), metavar='N',
                        help='runs at a time (default: the number of cores)')
    # For scripts/validate, which asks before it builds.
    parser.add_argument('--check-arguments', action='store_true', help=argparse.SUPPRESS)
    return parser.parse_args(words)


def print_summary(sections, failed):
    checks = [check for section in sections for check in section.checks]
    missed = [check for check in checks if not check.passed]
    for check in missed:
        print(f'MISSED {check.part}: {check.name}: {check.value:.6g} {check.unit}, reference '
              f'{check.reference}, error {check.error:+.3g} {check.error_unit}, tolerance '
              f'{check.tolerance:g} {check.error_unit}')
    for name, status, line in failed:
        print(f'FAILED {name} (status {status}): {line}')
    print(f'{len(checks) - len(missed)} tolerances hold, {len(missed)} missed, '
          f'{len(failed)} runs failed')
    return 1 if missed or failed else 0


def main():
    begin = time.monotonic()
    arguments = parse(sys.argv[1:])
    if arguments.check_arguments:
        return 0
    parts = [part for name, part in PARTS.items() if name in (arguments.only or PARTS)]
    jobs = [job for part in parts for job in part.jobs(arguments.quick)]
    runner = Runner()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        for mesh in sorted({job.mesh for job in jobs if isinstance(job, Grip)}):
            meshes.generate(mesh)
        records = runner.perform(jobs, arguments.jobs, arguments.fresh, Progress())
        later = [job for part in parts if hasattr(part, 'followups')
                 for job in part.followups(Results(runner, records), arguments.quick)]
        if later:
            records.update(runner.perform(later, arguments.jobs, arguments.fresh, Progress()))
    except KeyboardInterrupt:
        print('\nvalidate: interrupted; what is finished is kept', file=sys.stderr)
        return 130
    except RuntimeError as error:
        print(f'validate: {error}', file=sys.stderr)
        return 1
    results = Results(runner, records)
    sections = [part.evaluate(results, arguments.quick) for part in parts]
    failed = results.failed()
    csv_files.write_all(sections, failed)
    path = report.write(sections, failed,
                        origin(sys.argv[1:], time.monotonic() - begin, arguments.jobs))
    status = print_summary(sections, failed)
    print(f'report: {path.relative_to(path.parents[2])}')
    return status


if __name__ == '__main__':
    sys.exit(main())
