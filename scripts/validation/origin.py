"""What was run, where and when: for the head of the report."""

import datetime
import os
import platform
import subprocess

from .paths import REPOSITORY


def git(*arguments):
    try:
        return subprocess.run(['git', *arguments], cwd=REPOSITORY, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ''


def commit():
    name = git('rev-parse', 'HEAD') or 'unknown (no git)'
    return name + (' with changes that are not committed' if git('status', '--porcelain') else '')


def cpu():
    try:
        with open('/proc/cpuinfo', encoding='utf-8') as stream:
            for line in stream:
                if line.startswith('model name'):
                    return line.partition(':')[2].strip()
    except OSError:
        pass
    return platform.processor() or 'unknown'


def origin(arguments, seconds, jobs):
    """(name, text) each."""
    now = datetime.datetime.now(datetime.timezone.utc)
    return [('commit', commit()),
            ('command', ' '.join(['./scripts/validate', *arguments])),
            ('date', now.strftime('%Y-%m-%d %H:%M UTC')),
            ('machine', f'{cpu()}, {os.cpu_count()} cores; {jobs} runs at a time, one thread each'),
            ('this call took', f'{seconds / 60.0:.1f} min; finished runs of earlier calls are used '
                               'again')]
