"""What a sweep costs beyond its runs: overhead of a task of Dask, memory of a worker, size of the tables.

    python python/benchmarks/distributed_sweep.py

It makes runs of a pendulum of half a millisecond on a local cluster of two workers with one thread each, in batches of 1, 10 and 100.
The runs are short, so that the time of the scheduler and of the process that keeps the rows dominates.
"""

import json
import os
import resource
import tempfile
import time
from pathlib import Path

from distributed import Client, LocalCluster

import looselink

TOP = Path(__file__).resolve().parents[2]
RUNS = 2000


def memory():
    """Resident memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def study(runs):
    """Runs of a millisecond or less."""
    return {
        "title": "many short runs",
        "scene": TOP / "scenes/pendulum.toml",
        "set": ["simulation.duration=0.02"],
        "parameters": {"gravity": {"fields": ["simulation.gravity.1"], "from": -20.0, "to": -1.0, "count": runs}},
        "measures": {"kinetic": {"of": "largest", "channels": ["energy.kinetic"]}},
    }


def main():
    with tempfile.TemporaryDirectory() as folder:
        begun = time.monotonic()
        looselink.sweep(study(RUNS), out=f"{folder}/threads", threads=2)
        seconds = time.monotonic() - begun
        print(f"two threads: {1e3 * seconds / RUNS:.2f} ms a run, tables included")
        begun = time.monotonic()
        with open(f"{folder}/line", "wb", buffering=0) as file:
            for _ in range(RUNS):
                file.write(b"a line\n")
                os.fsync(file.fileno())
        print(f"a line that is put on the disk: {1e3 * (time.monotonic() - begun) / RUNS:.3f} ms")
        for name in ("runs.jsonl", "sweep.csv", "sweep.parquet"):
            print(f"{name}: {Path(folder, 'threads', name).stat().st_size / RUNS:.0f} bytes a run")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            idle = max(client.run(memory).values())
            for batch, tasks in ((1, 1000), (10, 500), (100, 200)):
                runs = batch * tasks
                begun = time.monotonic()
                result = looselink.sweep(study(runs), client, out=f"{folder}/{batch}", batch=batch)
                seconds = time.monotonic() - begun
                lines = Path(result.folder, "times.jsonl").read_text().splitlines()
                own = sum(json.loads(line)["wall"] for line in lines)
                overhead = (2 * seconds - own) / tasks
                print(
                    f"batches of {batch}: {1e3 * seconds / runs:.2f} ms a run, {tasks / seconds:.0f} tasks a second, "
                    f"{1e3 * overhead:.1f} ms of a worker a task beyond its runs"
                )
            begun = time.monotonic()
            looselink.sweep(study(100_000), client, out=f"{folder}/usual")
            print(f"100 000 runs in tasks of the usual length: {time.monotonic() - begun:.0f} s, {memory():.0f} MB in this process")
            print(f"memory of a worker: {idle:.0f} MB at rest, {max(client.run(memory).values()):.0f} MB after the sweeps")


if __name__ == "__main__":
    main()
