"""How far the runs are: one line that moves on a terminal, a line a run elsewhere."""

import sys
import threading
import time


def clock(seconds):
    minutes = int(seconds) // 60
    return f'{minutes // 60}:{minutes % 60:02d}:{int(seconds) % 60:02d}' if minutes >= 60 \
        else f'{minutes}:{int(seconds) % 60:02d}'


class Progress:
    """Counts runs; the time left is the weight left at the pace so far."""

    def __init__(self, stream=sys.stdout):
        self.stream = stream
        self.lock = threading.Lock()
        self.running = []

    def begin(self, total, cached, weight):
        self.total, self.done, self.weight = total, cached, weight
        self.weight_done, self.start = 0.0, time.monotonic()
        self.print_line(f'{total} runs, {cached} of them finished before; '
                        f'about {clock(weight)} to go')

    def started(self, name):
        with self.lock:
            self.running.append(name)
            self.show()

    def finished(self, name, record, good, weight):
        with self.lock:
            self.running.remove(name)
            self.done += 1
            self.weight_done += weight
            if not good:
                self.print_line(f'FAILED {name} (status {record["status"]}): '
                                f'{record["last_line"]}')
            if self.stream.isatty():
                self.show()
            else:
                self.print_line(f'[{self.done:3d}/{self.total}] {self.times()}  '
                                f'{name} {record["seconds"]:.1f} s')

    def times(self):
        elapsed = time.monotonic() - self.start
        if not self.weight_done:
            return f'{clock(elapsed)} elapsed'
        left = elapsed * max(0.0, self.weight - self.weight_done) / self.weight_done
        return f'{clock(elapsed)} elapsed, about {clock(left)} left'

    def show(self):
        if self.stream.isatty() and self.running:
            line = f'[{self.done}/{self.total}] {self.times()}  {self.running[-1]}'
            self.stream.write(f'\r\033[K{line:.110}')
            self.stream.flush()

    def print_line(self, line):
        clear = '\r\033[K' if self.stream.isatty() else ''
        print(clear + line, file=self.stream, flush=True)

    def end(self):
        if self.stream.isatty():
            self.stream.write('\r\033[K')
        print(f'runs: {clock(time.monotonic() - self.start)}', file=self.stream, flush=True)
