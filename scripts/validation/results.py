"""The finished runs, for the parts to ask."""

import yaml

from .series import Series


class Results:
    """Looks up what a job left; series are read once."""

    def __init__(self, runner, records):
        self.runner, self.records, self.cache = runner, records, {}

    def folder(self, job):
        return self.runner.folder(job)

    def ok(self, job):
        """The job was run and ended as it may."""
        return job in self.records and self.records[job]['status'] in job.allowed()

    def series(self, grip):
        """Series of a grip; None if it failed."""
        if not self.ok(grip):
            return None
        if grip not in self.cache:
            self.cache[grip] = Series(self.folder(grip) / 'timeseries.csv', grip)
        return self.cache[grip]

    def summary(self, grip):
        """The figures of summary.yaml by name."""
        with open(self.folder(grip) / 'summary.yaml', encoding='utf-8') as file:
            return yaml.safe_load(file)

    def num_elements(self, grip):
        return self.summary(grip)['elements']

    def failed(self):
        """(id, status, last line of output) of runs that ended as they may not."""
        return [(job.id, record['status'], record['last_line'])
                for job, record in self.records.items() if record['status'] not in job.allowed()]
