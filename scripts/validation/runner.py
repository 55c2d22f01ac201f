"""Runs jobs, a few at a time, and remembers those that are finished.

A job has: id, cost [s], alone, command(folder), inputs(), allowed(). A finished one leaves run.json
in its folder, written last; as long as its fingerprint holds, the job is not run again.
"""

import concurrent.futures
import json
import os
import shutil
import subprocess
import threading
import time

from .fingerprint import fingerprint
from .paths import REPOSITORY, RUNS


class Runner:
    """Runs jobs into a folder each."""

    def __init__(self, folder=RUNS, directory=REPOSITORY):
        self.root = folder
        self.directory = directory
        self.processes = set()
        self.lock = threading.Lock()
        self.stopped = False

    def folder(self, job):
        return self.root / job.id

    def fingerprint(self, job):
        return fingerprint(job.command(self.folder(job)), job.inputs())

    def record(self, job):
        """What the finished run left; None if it has to be run."""
        try:
            record = json.loads((self.folder(job) / 'run.json').read_text())
        except (OSError, ValueError):
            return None
        # One that a signal ended says nothing of the job.
        finished = record.get('status', -1) >= 0
        return record if finished and record['fingerprint'] == self.fingerprint(job) else None

    def run(self, job):
        """Runs one job anew. Returns its record."""
        folder = self.folder(job)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        command = [str(word) for word in job.command(folder)]
        record = {'fingerprint': self.fingerprint(job), 'command': command}
        begin = time.monotonic()
        with open(folder / 'output.log', 'wb') as output:
            with self.lock:
                if self.stopped:
                    raise InterruptedError
                process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                           stderr=subprocess.STDOUT, cwd=self.directory,
                                           env={**os.environ, 'OMP_NUM_THREADS': '1'})
                self.processes.add(process)
            record['status'] = process.wait()
        with self.lock:
            self.processes.discard(process)
            if self.stopped:
                raise InterruptedError
        record['seconds'] = time.monotonic() - begin
        text = (folder / 'output.log').read_text(encoding='utf-8', errors='replace').strip()
        record['last_line'] = text.splitlines()[-1] if text else ''
        unfinished = folder / 'run.json.part'
        unfinished.write_text(json.dumps(record, indent=1) + '\n')
        unfinished.rename(folder / 'run.json')
        return record

    def stop(self):
        """Ends what runs."""
        with self.lock:
            self.stopped = True
            for process in self.processes:
                process.terminate()

    def perform(self, jobs, workers, fresh, progress):
        """Runs what is not finished: the long ones first, at last those that need to be alone.

        Returns {job: record}.
        """
        jobs = list(dict.fromkeys(jobs))
        records = {} if fresh else {job: self.record(job) for job in jobs}
        records = {job: record for job, record in records.items() if record}
        left = sorted((job for job in jobs if job not in records), key=lambda job: -job.cost)
        progress.begin(len(jobs), len(records), sum(self.wall(job, workers) for job in left))

        def perform_one(job):
            progress.started(job.id)
            record = self.run(job)
            progress.finished(job.id, record, record['status'] in job.allowed(),
                              self.wall(job, workers))
            return job, record

        for abreast, group in ((workers, [job for job in left if not job.alone]),
                               (1, [job for job in left if job.alone])):
            pool = concurrent.futures.ThreadPoolExecutor(abreast)
            futures = [pool.submit(perform_one, job) for job in group]
            try:
                for future in concurrent.futures.as_completed(futures):
                    job, record = future.result()
                    records[job] = record
            except BaseException:
                for future in futures:
                    future.cancel()
                self.stop()
                raise
            finally:
                pool.shutdown()
        progress.end()
        return {job: records[job] for job in jobs}

    @staticmethod
    def wall(job, workers):
        """A job's share of the time that all take, roughly. [s]"""
        return job.cost if job.alone else job.cost / workers
