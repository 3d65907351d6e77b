"""Runs the same files through the plain batch, Ray and Spark, kills workers on the way, and compares bytes and CPU time.

    python measure.py --program target/release/pathwarp --source drawings/ --count 20000 [--kill] [ray] [spark]

Exits with 1 if a file is missing, differs, or is listed twice. CPU time is that of all processes of a system, its scheduler and its
Java machine included, without starting it: a cluster runs already.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from typing import Any, Callable, Dict, List

import psutil

import pathwarp


def copies(source: pathlib.Path, folder: pathlib.Path, count: int) -> None:
    """`count` drawings, all different: those of `source` over and over, each with its number in a comment."""
    drawings = sorted(p for p in source.rglob("*.svg"))
    for i in range(count):
        drawing = drawings[i % len(drawings)]
        target = folder / f"{i // 1000:03}" / f"{i:05}-{drawing.name}"
        target.parent.mkdir(parents=True, exist_ok=True)
        text = drawing.read_bytes()
        end = text.rfind(b"</svg>")
        target.write_bytes(text[:end] + b"<!-- %d -->" % i + text[end:])


class Watch(threading.Thread):
    """Adds up the CPU time of all processes below this one, and kills a worker from time to time."""

    def __init__(self, is_worker: Callable[[psutil.Process], bool], kills: int) -> None:
        super().__init__(daemon=True)
        self.is_worker, self.kills, self.killed = is_worker, kills, 0
        self.first: Dict[Any, float] = {}
        self.last: Dict[Any, float] = {}
        self.ended = threading.Event()
        self.own = 0.0
        self.look(begin=True)

    def look(self, begin: bool = False) -> List[psutil.Process]:
        me = psutil.Process()
        alive = []
        for p in [me, *me.children(recursive=True)]:
            try:
                times = p.cpu_times()
                key = (p.pid, p.create_time())
            except psutil.Error:
                continue
            self.last[key] = times.user + times.system
            if begin:
                self.first[key] = self.last[key]
            alive.append(p)
        return alive

    def works(self, p: psutil.Process) -> bool:
        try:
            return p.status() != psutil.STATUS_ZOMBIE and self.is_worker(p)
        except psutil.Error:
            return False

    def run(self) -> None:
        random.seed(1)
        next_kill = time.monotonic() + 0.5
        while not self.ended.wait(0.2):
            self.own = time.thread_time()
            alive = self.look()
            if self.killed < self.kills and time.monotonic() > next_kill:
                workers = [p for p in alive if self.works(p)]
                if workers:
                    random.choice(workers).kill()
                    self.killed += 1
                next_kill = time.monotonic() + 1

    def seconds(self) -> float:
        self.ended.set()
        self.join()
        self.look()
        return sum(last - self.first.get(key, 0.0) for key, last in self.last.items()) - self.own


def digests(folder: pathlib.Path) -> Dict[str, str]:
    found = {}
    for file in folder.rglob("*"):
        # A killed worker may leave its temporary file.
        if file.is_file() and not file.name.startswith(".pathwarp-"):
            found[str(file.relative_to(folder))] = hashlib.sha256(file.read_bytes()).hexdigest()
    return found


def compare(name: str, plain: Dict[str, str], folder: pathlib.Path, listed: Any) -> bool:
    """The results of a system against those of the plain batch."""
    written = digests(folder)
    good = listed[listed.error == ""]
    problems = {
        "missing": len(plain.keys() - written.keys()),
        "too many": len(written.keys() - plain.keys()),
        "different": sum(1 for k in plain.keys() & written.keys() if plain[k] != written[k]),
        "listed twice": int(listed.path.duplicated().sum()),
        "not listed": len(plain.keys() - set(good.path)),
        "listed wrong": sum(1 for p, s in zip(good.path, good.sha256) if plain.get(p) != s),
    }
    if any(problems.values()):
        print(f"{name}: " + ", ".join(f"{n} {what}" for what, n in problems.items() if n))
        return False
    print(f"{name}: {len(written)} files, the same bytes as the plain batch; {len(listed) - len(good)} inputs failed in both")
    return True


def report(name: str, count: int, cpu: float, wall: float, plain: float) -> None:
    share = plain / cpu
    print(f"{name}: {cpu:.1f} s of CPU time for {count} files, {count / cpu:.0f} per second of a core, {share:.2f} of the plain batch; {wall:.1f} s by the clock")


def by_ray(args: Any, source: pathlib.Path, folder: pathlib.Path, deformation: pathwarp.Deformation) -> Any:
    import ray

    import ray_warp

    ray.data.DataContext.get_current().enable_progress_bars = False
    ray.init(num_cpus=args.workers, _node_ip_address="127.0.0.2", include_dashboard=False, log_to_driver=False)
    warm = folder.parent / "warm"
    copies(args.source, warm / "in", args.count // 10)
    ray_warp.run(str(warm / "in"), str(warm / "out"), deformation, {}, args.workers, args.read)
    is_worker = lambda p: "warp" in " ".join(p.cmdline()) and p.cmdline()[0].startswith("ray::")  # noqa: E731
    return Watch(is_worker, args.kill), lambda: ray_warp.run(str(source), str(folder), deformation, {}, args.workers, args.read).to_pandas()


def by_spark(args: Any, source: pathlib.Path, folder: pathlib.Path, deformation: pathwarp.Deformation) -> Any:
    import spark_warp

    spark = spark_warp.session(args.workers)
    warm = folder.parent / "warm"
    copies(args.source, warm / "in", args.count // 10)
    run = lambda a, b: spark_warp.run(spark, str(a), str(b), deformation, {}, f"{b}.results", args.read).toPandas()  # noqa: E731
    # Java compiles what runs often.
    for _ in range(3):
        run(warm / "in", warm / "out")

    def is_worker(p: psutil.Process) -> bool:
        # The daemon forks the workers; they have its command line.
        parent = p.parent()
        return all("pyspark.daemon" in " ".join(q.cmdline()) for q in (p, parent)) if parent else False

    return Watch(is_worker, args.kill), lambda: run(source, folder)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--kill", type=int, default=0, metavar="N", help="kill N workers on the way")
    parser.add_argument("--read", choices=("worker", "system"), default="worker", help="who reads the files")
    parser.add_argument("systems", nargs="+", choices=("ray", "spark"))
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pathwarp-scale-") as made:
        root = pathlib.Path(made)
        copies(args.source.resolve(), root / "in", args.count)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        clock = time.monotonic()
        words = ["warp", "--style", "arc", "--bend", "40%", "--quiet", "--jobs", str(args.workers), "-r", root / "in"]
        done = subprocess.run([args.program, *words, "--out-dir", root / "plain"], capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        plain_cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        report("plain batch", args.count, plain_cpu, time.monotonic() - clock, plain_cpu)
        plain = digests(root / "plain")
        deformation = pathwarp.Deformation("arc", bend="40%")
        good = True
        for system in args.systems:
            folder = root / system / "out"
            watch, run = (by_ray if system == "ray" else by_spark)(args, root / "in", folder, deformation)
            clock = time.monotonic()
            watch.start()
            listed = run()
            wall = time.monotonic() - clock
            cpu = watch.seconds()
            report(f"{system}, {watch.killed} workers killed", args.count, cpu, wall, plain_cpu)
            if watch.killed < args.kill:
                print(f"{system}: only {watch.killed} workers could be killed before the end; more files would show more")
            good &= compare(system, plain, folder, listed)
            shutil.rmtree(root / system)
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
